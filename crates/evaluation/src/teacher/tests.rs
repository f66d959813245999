use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use opendr_engine::data::Vector;
use opendr_engine::dataset::{Dataset, Sample};
use opendr_engine::learner::{Output, Outputs, Port, Ports, Spec};
use opendr_engine::target::{BoundingBox, BoundingBoxList, Name};
use opendr_engine::{Silent, Task};

use super::*;

const PORTS: &[Port] =
    &[Port { name: "vector", doc: "", value_type: ValueType::Vector, optional: false, init: false }];
const OUTPUTS: &[Output] = &[Output { name: "boxes", doc: "", value_type: ValueType::BoundingBoxList }];

/// Predicts as many boxes as the sample's number, with increasing scores; the first is a kite, all others are persons.
struct Finder(Arc<AtomicUsize>);

impl AnyStream for Finder {
    fn infer(&mut self, ports: &Ports<'_>) -> Result<Outputs> {
        self.0.fetch_add(1, Ordering::Relaxed);
        let count = ports.required::<Vector>("vector")?.as_slice()[0] as usize;
        if count == 9 {
            return Err(Error::format("unreadable"));
        }
        let boxes = (0..count).map(|at| {
            let name = if at == 0 { 0 } else { 1 };
            BoundingBox::new(name, at as f32, 0.0, 1.0, 1.0, 0.25 * (at + 1) as f32)
        });
        let mut list = BoundingBoxList::from(boxes.collect::<Vec<_>>());
        list.classes = classes();
        Ok([("boxes", Value::from(list))].into_iter().collect())
    }

    fn push(&mut self, _: Option<&Ports<'_>>, _: &mut dyn FnMut(Outputs)) -> Result<()> {
        Err(Error::unsupported("push"))
    }

    fn reset(&mut self) {}
}

fn classes() -> Classes {
    ["kite", "person"].into_iter().collect()
}

/// Samples without targets.
struct Numbers(Vec<usize>, Classes);

impl Dataset for Numbers {}

impl DatasetIterator for Numbers {
    fn len(&self) -> usize {
        self.0.len()
    }

    fn get(&self, index: usize) -> Result<Sample> {
        let data = vec![Vector::new(vec![self.0[index] as f32], [1])?.into()];
        Ok(Sample { data, target: None })
    }

    fn classes(&self) -> Classes {
        self.1.clone()
    }
}

struct Setup {
    folder: PathBuf,
    processed: Arc<AtomicUsize>,
}

impl Setup {
    fn new(name: &str) -> Self {
        let folder = std::env::temp_dir().join(format!("opendr-teacher-{name}-{}", std::process::id()));
        Self { folder, processed: Arc::default() }
    }

    fn teacher(&self) -> Teacher {
        let spec = Spec::new("finder", Task::ObjectDetection2d).class("FinderLearner");
        let entry = Entry::dynamic(spec, &[], PORTS, OUTPUTS, |_, _| Err(Error::unsupported("making")));
        let stream = || Box::new(Finder(self.processed.clone())) as Box<dyn AnyStream>;
        Teacher {
            subject: Subject { learner: "finder".to_owned(), ..Subject::default() },
            entry: Box::leak(Box::new(entry)),
            classes: classes(),
            streams: vec![stream(), stream()],
        }
    }

    fn teach(
        &self,
        samples: &Numbers,
        problems: &Problems,
        change: impl FnOnce(&mut Distillation<'_>),
    ) -> Result<Vec<Labelled>> {
        let mut lesson = Distillation {
            dataset: "numbers".to_owned(),
            annotation_type: ValueType::BoundingBoxList,
            threshold: 0.5,
            classes: Classes::default(),
            class_matching: ClassMatching::default(),
            keep_empty: false,
            folder: &self.folder,
            problems,
            progress: &Silent,
        };
        change(&mut lesson);
        let labelled = lesson.label(self.teacher(), Box::new(samples))?;
        assert!(labelled.is_complete());
        (0..labelled.len()).map(|at| Ok((labelled.name(at), labels(&labelled.get(at)?)))).collect()
    }
}

impl Drop for Setup {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.folder);
    }
}

/// Name of a sample, and class and position of each of its boxes.
type Labelled = (String, Vec<(Name, f32)>);

fn labels(sample: &Sample) -> Vec<(Name, f32)> {
    let Some(Value::BoundingBoxList(list)) = &sample.target else { panic!("{sample:?}") };
    list.boxes.iter().map(|found| (found.name.clone(), found.left)).collect()
}

#[test]
fn confident_predictions_become_annotations_in_the_classes_of_the_data_set() {
    let setup = Setup::new("classes");
    let of_dataset: Classes = ["cat", "Person"].into_iter().collect();
    let samples = Numbers(vec![1, 3, 0, 2], of_dataset);
    let labelled = setup.teach(&samples, &Problems::strict(), |_| {}).unwrap();
    let person = |left| (Name::Index(1), left);
    assert_eq!(
        labelled,
        [("1".to_owned(), vec![person(1.0), person(2.0)]), ("3".to_owned(), vec![person(1.0)])]
    );
    let with_negatives =
        setup.teach(&samples, &Problems::strict(), |lesson| lesson.keep_empty = true).unwrap();
    assert_eq!(with_negatives.len(), 4);
    assert!(with_negatives[2].1.is_empty());
    // The same predictions serve other thresholds and classes.
    let kites = setup.teach(&samples, &Problems::strict(), |lesson| {
        (lesson.threshold, lesson.classes) = (0.2, ["kite"].into_iter().collect());
    });
    assert_eq!(kites.unwrap().iter().map(|(name, _)| &**name).collect::<Vec<_>>(), ["0", "1", "3"]);
    assert_eq!(setup.processed.load(Ordering::Relaxed), 4);
}

#[test]
fn a_distillation_resumes_from_its_journal() {
    let setup = Setup::new("resumed");
    let samples = Numbers(vec![2; 6], Classes::default());
    let whole = setup.teach(&samples, &Problems::strict(), |_| {}).unwrap();
    let journal = setup.folder.join(JOURNAL);
    let text = fs::read_to_string(&journal).unwrap();
    let cut: usize = text.lines().take(3).map(|line| line.len() + 1).sum();
    fs::write(&journal, &text[..cut + 5]).unwrap();
    assert_eq!(setup.teach(&samples, &Problems::strict(), |_| {}).unwrap(), whole);
    assert_eq!(setup.processed.load(Ordering::Relaxed), 6 + 4);
    assert_eq!(fs::read_to_string(&journal).unwrap(), text);
    let others = Numbers(vec![2; 5], Classes::default());
    let error = setup.teach(&others, &Problems::strict(), |_| {}).unwrap_err();
    assert!(error.to_string().contains("data set differs"), "{error}");
}

#[test]
fn samples_without_predictions_are_reported_or_skipped() {
    let setup = Setup::new("broken");
    let samples = Numbers(vec![3, 9, 3], Classes::default());
    let error = setup.teach(&samples, &Problems::strict(), |_| {}).unwrap_err();
    assert!(error.to_string().contains("unreadable"), "{error}");
    let problems = Problems::skipping();
    assert_eq!(setup.teach(&samples, &problems, |_| {}).unwrap().len(), 2);
    assert_eq!(problems.count(), 1);
    let poses = |lesson: &mut Distillation<'_>| lesson.annotation_type = ValueType::PoseList;
    let error = setup.teach(&samples, &problems, poses).unwrap_err();
    assert!(error.to_string().contains("finder predicts BoundingBoxList, but"), "{error}");
}
