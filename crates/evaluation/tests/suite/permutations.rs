//! No metric depends on the numbering of classes, on either side.

use std::collections::BTreeMap;

use opendr_datasets::Problems;
use opendr_engine::data::Vector;
use opendr_engine::dataset::{Dataset, DatasetIterator, Sample};
use opendr_engine::learner::{Inputs, Outputs, Ports};
use opendr_engine::target::{
    BoundingBox, BoundingBox3D, BoundingBox3DList, BoundingBoxList, Category, Classes, Heatmap,
    TrackingAnnotation3D, TrackingAnnotation3DList,
};
use opendr_engine::{Random, Result, Value};
use opendr_evaluation::{Evaluation, Predictor, Subject};
use opendr_metrics::{LABEL_DIVISOR, find};
use proptest::prelude::*;

const NAMES: [&str; 6] = ["car", "pedestrian", "Cyclist", "van", "tram", "traffic sign"];
const SAMPLES: usize = 8;

/// The classes in a permuted order.
#[derive(Debug, Clone)]
struct Numbering(Vec<usize>);

impl Numbering {
    fn classes(&self) -> Classes {
        self.0.iter().map(|class| NAMES[*class]).collect()
    }

    /// Returns the number of a class.
    fn of(&self, class: usize) -> usize {
        self.0.iter().position(|other| *other == class).unwrap()
    }
}

/// Returns the ground truth or the prediction of a sample; classes are indices into [`NAMES`].
fn value(
    metric: &str,
    numbering: &Numbering,
    random: &mut Random,
    is_truth: bool,
    noise: &mut Random,
) -> Value {
    let class = |random: &mut Random, noise: &mut Random| {
        let class = random.below(NAMES.len());
        // One prediction in four has another class.
        if !is_truth && noise.chance(0.25) { noise.below(NAMES.len()) } else { class }
    };
    let classes = numbering.classes();
    match metric {
        "classification" => {
            let class = class(random, noise);
            let mut category = Category::new(numbering.of(class) as i64, None);
            if !is_truth {
                // Few levels, so that scores are often equal.
                let scores: Vec<f32> = (0..NAMES.len()).map(|_| noise.below(4) as f32 / 4.0).collect();
                category.probabilities = numbering.0.iter().map(|class| scores[*class]).collect();
                category.confidence = Some(scores[class]);
            }
            category.into()
        }
        "segmentation" => {
            let labels = (0..64).map(|_| numbering.of(class(random, noise)) as u32).collect();
            labelled(labels, classes)
        }
        "panoptic" => {
            let mut labels = Vec::new();
            for object in 0..8_u32 {
                let label = numbering.of(class(random, noise)) as u32 * LABEL_DIVISOR + object + 1;
                labels.extend([label; 8]);
            }
            labelled(labels, classes)
        }
        "kitti_detection" | "tracking_3d" => {
            let found = |at: usize, random: &mut Random, noise: &mut Random| {
                let class = class(random, noise);
                BoundingBox3D {
                    name: (numbering.of(class) as i64).into(),
                    bbox2d: [100.0 * at as f32, 100.0, 100.0 * at as f32 + 80.0, 180.0],
                    dimensions: [4.0, 1.5, 1.6],
                    location: [8.0 * at as f32, 1.5, 20.0 + noise.uniform(0.0, 0.5)],
                    confidence: if is_truth { 1.0 } else { noise.uniform(0.1, 1.0) },
                    ..BoundingBox3D::default()
                }
            };
            let boxes: Vec<_> = (0..5).map(|at| found(at, random, noise)).collect();
            if metric == "kitti_detection" {
                return BoundingBox3DList { boxes, classes, ..BoundingBox3DList::default() }.into();
            }
            let tracks = boxes.into_iter().zip(1..).map(|(bounding_box_3d, id)| TrackingAnnotation3D {
                bounding_box_3d,
                id,
                frame: None,
            });
            TrackingAnnotation3DList { annotations: tracks.collect(), classes, ..Default::default() }.into()
        }
        _ => {
            let found = |at: usize, random: &mut Random, noise: &mut Random| {
                let class = numbering.of(class(random, noise)) as i64;
                let left = 40.0 * at as f32 + noise.uniform(0.0, 8.0);
                BoundingBox::new(
                    class,
                    left,
                    10.0,
                    30.0,
                    30.0,
                    if is_truth { 1.0 } else { noise.uniform(0.0, 1.0) },
                )
            };
            let boxes = (0..6).map(|at| found(at, random, noise)).collect();
            BoundingBoxList { boxes, classes, ..BoundingBoxList::default() }.into()
        }
    }
}

fn labelled(labels: Vec<u32>, classes: Classes) -> Value {
    let mut map = Heatmap::from_labels(labels, &[8, 8]).unwrap();
    map.classes = classes;
    map.into()
}

struct GroundTruths {
    values: Vec<Value>,
    classes: Classes,
}

impl Dataset for GroundTruths {}

impl DatasetIterator for GroundTruths {
    fn len(&self) -> usize {
        self.values.len()
    }

    fn get(&self, index: usize) -> Result<Sample> {
        let data = vec![Vector::new(vec![index as f32], [1])?.into()];
        Ok(Sample { data, target: Some(self.values[index].clone()) })
    }

    fn classes(&self) -> Classes {
        self.classes.clone()
    }
}

struct Predictions(Vec<Value>);

impl Predictor for Predictions {
    fn reset(&mut self) {}

    fn infer(&mut self, ports: &Ports<'_>) -> Result<Outputs> {
        let at = ports.required::<Vector>("vector")?.as_slice()[0] as usize;
        Ok([("prediction", self.0[at].clone())].into_iter().collect())
    }
}

/// Returns all numbers of the report, including those of each class by its name.
fn numbers(metric: &str, learner: &Numbering, dataset: &Numbering, seed: u64) -> BTreeMap<String, f64> {
    let [mut ground_truths, mut predictions] = [Vec::new(), Vec::new()];
    for at in 0..SAMPLES {
        let place = |what| Random::from_key([seed, at as u64, what]);
        ground_truths.push(value(metric, dataset, &mut place(0), true, &mut place(1)));
        predictions.push(value(metric, learner, &mut place(0), false, &mut place(2)));
    }
    let problems = Problems::strict();
    let evaluation =
        Evaluation { resamples: 0, ..Evaluation::new(Subject::default(), find(metric).unwrap(), &problems) };
    let ground_truths = GroundTruths { values: ground_truths, classes: dataset.classes() };
    let ports = <&Vector as Inputs<'_>>::PORTS;
    let outcome = evaluation
        .run_pipelines(&mut [Predictions(predictions)], ports, learner.classes(), &ground_truths)
        .unwrap();
    let mut numbers = outcome.report.statistics.scalars.clone();
    for table in &outcome.report.tables {
        for (row, values) in &table.rows {
            for (column, value) in table.columns.iter().zip(values) {
                numbers.insert(format!("{}/{row}/{column}", table.name), value.unwrap_or(f64::NAN));
            }
        }
    }
    numbers
}

fn numbering() -> impl Strategy<Value = Numbering> {
    Just((0..NAMES.len()).collect::<Vec<_>>()).prop_shuffle().prop_map(Numbering)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, ..ProptestConfig::default() })]
    #[test]
    fn no_permutation_of_classes_changes_a_number(learner in numbering(), dataset in numbering(), seed in 0..1000_u64) {
        let in_order = Numbering((0..NAMES.len()).collect());
        for metric in [
            "classification", "coco_detection", "voc_detection", "segmentation", "panoptic", "kitti_detection", "tracking_3d",
        ] {
            let wanted = numbers(metric, &in_order, &in_order, seed);
            let found = numbers(metric, &learner, &dataset, seed);
            prop_assert_eq!(wanted.keys().collect::<Vec<_>>(), found.keys().collect::<Vec<_>>());
            for (name, number) in &wanted {
                let other = found[name];
                let same = (number - other).abs() <= 1e-12 || number.is_nan() && other.is_nan();
                prop_assert!(same, "{metric}: {name} is {number} and {other}");
            }
        }
    }
}
