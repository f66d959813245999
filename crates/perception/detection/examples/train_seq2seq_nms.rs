//! Trains a Seq2Seq-NMS on the persons of COCO128 and compares it with greedy suppression of the same boxes.
//!
//! ```console
//! $ cargo run --release -p opendr-detection --features training --example train_seq2seq_nms -- DATA DETECTOR \
//!     OUTPUT [PARAMETER=VALUE ...]
//! ```
//!
//! DATA contains `coco128`: its train split is for training, its val split for evaluation. DETECTOR is a container from
//! `opendr download`, such as NanoDet's; its suppression is switched off.

use std::path::Path;

use opendr_datasets::{OpenOptions, Problems};
use opendr_detection::object_detection_2d::{
    DETECTORS, NmsVariant, Seq2SeqNms, Seq2SeqNmsFitParams, Seq2SeqNmsInputs, Seq2SeqNmsParams,
};
use opendr_engine::dataset::{DatasetIterator, ExternalDataset};
use opendr_engine::learner::{FitJob, Handle};
use opendr_engine::model::Model;
use opendr_engine::params::{ParamMap, Params};
use opendr_engine::target::{BoundingBox, BoundingBoxList};
use opendr_engine::{Device, Error, Progress, Result, Unit, Value};
use opendr_metrics::{CocoDetection, Metric};
use opendr_perception_common::suppression::{Candidate, Suppression, SuppressionKind};
use opendr_tiling::open_image_learner;

/// IoU thresholds of greedy suppression to compare with.
const OVERLAPS: [f32; 6] = [0.45, 0.5, 0.55, 0.6, 0.65, 0.7];

/// Progress as lines on the terminal.
struct Lines;

impl Progress for Lines {
    fn begin(&self, _: &str, _: Option<u64>, _: Unit) {}
    fn advance(&self, _: u64) {}
    fn end(&self) {}
    fn note(&self, line: &str) {
        println!("{line}");
    }
}

fn open_split(data: &Path, split: &str) -> Result<Box<dyn DatasetIterator>> {
    let dataset = ExternalDataset::new(data.join("coco128/object_detection"), "yolo");
    let options = OpenOptions { split: Some(split.to_owned()), ..OpenOptions::default() };
    opendr_datasets::open(&dataset, &options, &Problems::strict())
}

fn persons(mut list: BoundingBoxList) -> BoundingBoxList {
    let classes = std::mem::replace(&mut list.classes, ["person"].into_iter().collect());
    list.boxes.retain(|found| classes.label(&found.name) == Some("person"));
    list.boxes.iter_mut().for_each(|found| found.name = 0.into());
    list
}

fn suppressed(found: &BoundingBoxList, kind: SuppressionKind, overlap: f32) -> BoundingBoxList {
    let candidate = |(index, found): (usize, &BoundingBox)| Candidate {
        corners: found.corners(),
        score: found.confidence,
        class: 0,
        index: index as u32,
    };
    let mut candidates: Vec<_> = found.boxes.iter().enumerate().map(candidate).collect();
    Suppression { kind, iou_threshold: overlap, threshold: 0.01, max_boxes: 400 }
        .run(&mut candidates, &mut Vec::new());
    let boxes = candidates.iter().map(|candidate| BoundingBox {
        confidence: candidate.score,
        ..found.boxes[candidate.index as usize].clone()
    });
    BoundingBoxList { boxes: boxes.collect(), classes: found.classes.clone(), ..Default::default() }
}

fn main() -> Result<()> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [data, detector, output, settings @ ..] = &arguments[..] else {
        return Err(Error::invalid_input("give DATA, DETECTOR and OUTPUT"));
    };
    let (data, output) = (Path::new(data), Path::new(output));
    let mut params = Seq2SeqNmsFitParams {
        variant: NmsVariant::Light,
        classes: vec!["person".to_owned()],
        detector: Some(detector.clone()),
        augmented_versions: 8,
        dropout: 0.1,
        ..Default::default()
    };
    (params.training.epochs, params.training.lr) = (12, 0.0005);
    (params.training.num_workers, params.training.log_after) = (2, 20);
    for setting in settings {
        let (name, value) = setting.split_once('=').ok_or_else(|| Error::invalid_input("give NAME=VALUE"))?;
        params.set_text(name, value)?;
    }
    let (dataset, val_dataset) = (open_split(data, "train")?, open_split(data, "val")?);
    let job = FitJob { device: Device::Cpu, progress: &Lines, ..FitJob::new(output) };
    let learner_params = Seq2SeqNmsParams { threshold: 0.0, ..Default::default() };
    let mut learner = Handle::<Seq2SeqNms>::new(learner_params, Device::Cpu)?;
    println!("{}", learner.fit(&params, (&*dataset).into(), None, &job)?);

    let overrides = ParamMap::from([
        ("threshold".to_owned(), 0.05.into()),
        ("iou_threshold".to_owned(), 1.0.into()),
        ("max_detections".to_owned(), 1000i64.into()),
    ]);
    let model = Model::open(Path::new(detector))?;
    let detector = open_image_learner(&model, DETECTORS, &overrides, Device::Cpu)?;
    let metric = || CocoDetection::new(&Default::default());
    let kinds = [SuppressionKind::Hard, SuppressionKind::Soft];
    let mut greedy = Vec::new();
    for (kind, overlap) in kinds.into_iter().flat_map(|kind| OVERLAPS.map(|overlap| (kind, overlap))) {
        greedy.push((kind, overlap, metric()?));
    }
    let (mut ours, mut boxes) = (metric()?, 0);
    for index in 0..val_dataset.len() {
        let sample = val_dataset.get(index)?;
        let ([Value::Image(image)], Some(Value::BoundingBoxList(ground_truth))) =
            (&sample.data[..], sample.target)
        else {
            return Err(Error::invalid_input("the sample is not an image with boxes"));
        };
        let (ground_truth, mut found) = (persons(ground_truth), BoundingBoxList::default());
        detector.predict_into(image, &mut found)?;
        let found = persons(found);
        boxes += found.boxes.len();
        for (kind, overlap, metric) in &mut greedy {
            metric.update(index, &suppressed(&found, *kind, *overlap), &ground_truth)?;
        }
        ours.update(index, &learner.infer(Seq2SeqNmsInputs { image, detections: &found })?, &ground_truth)?;
    }
    println!("{} images, {boxes} boxes of persons before suppression", val_dataset.len());
    let report = |name: &str, metric: &CocoDetection| {
        let numbers = metric.finish().statistics.scalars;
        let number = |key: &str| numbers.get(key).copied().unwrap_or(f64::NAN);
        println!("{name}: AP50 {:.4}, AP50:95 {:.4}", number("map50"), number("map"));
    };
    for (kind, overlap, metric) in &greedy {
        report(&format!("{} {overlap}", kind.name()), metric);
    }
    report("seq2seq_nms", &ours);
    Ok(())
}
