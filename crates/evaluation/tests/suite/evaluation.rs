//! A counting learner on generated data sets: resumption, sequences, broken samples.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, PoisonError};

use opendr_datasets::Problems;
use opendr_engine::data::Vector;
use opendr_engine::dataset::{Dataset, DatasetIterator, DatasetRef, Sample};
use opendr_engine::learner::{
    AnyLearner, AnyStream, Capabilities, Entry, FitJob, Inputs, Outputs, Ports, Spec, Targets,
};
use opendr_engine::params::{ParamMap, ParamValue};
use opendr_engine::target::{Category, Classes};
use opendr_engine::{Device, Error, Progress, Result, Statistics, Task, Unit, Value};
use opendr_evaluation::{Evaluation, Outcome, Subject};
use opendr_metrics::find;

/// Predicts how many samples of its stream it has processed.
#[derive(Default)]
struct Counter {
    processed: i64,
}

impl AnyLearner for Counter {
    fn infer(&mut self, ports: &Ports<'_>) -> Result<Outputs> {
        ports.required::<Vector>("vector")?;
        self.processed += 1;
        Ok([("category", Value::from(Category::new(self.processed, Some(1.0))))].into_iter().collect())
    }

    fn reset(&mut self) {
        self.processed = 0;
    }

    fn load(&mut self, _: &Path) -> Result<()> {
        Ok(())
    }

    fn save(&self, _: &Path) -> Result<()> {
        Ok(())
    }

    fn is_ready(&self) -> bool {
        true
    }

    fn push(&mut self, _: Option<&Ports<'_>>, _: &mut dyn FnMut(Outputs)) -> Result<()> {
        Err(Error::unsupported("push"))
    }

    fn fit(
        &mut self,
        _: &ParamMap,
        _: DatasetRef<'_>,
        _: Option<DatasetRef<'_>>,
        _: &FitJob<'_>,
    ) -> Result<Statistics> {
        Err(Error::unsupported("fit"))
    }

    fn stream(&self) -> Result<Box<dyn AnyStream>> {
        Err(Error::unsupported("stream"))
    }

    fn params(&self) -> ParamMap {
        ParamMap::new()
    }

    fn default_of(&self, _: &str) -> Option<ParamValue> {
        None
    }

    fn set(&mut self, _: &str, _: ParamValue) -> Result<()> {
        Ok(())
    }

    fn classes(&self) -> Classes {
        Classes::default()
    }

    fn device(&self) -> Device {
        Device::Cpu
    }

    fn capabilities(&self) -> Capabilities {
        Capabilities::default()
    }
}

/// Sequences of three frames with the classes 1, 2, 3; sample `broken` cannot be read.
struct Frames {
    count: usize,
    broken: Option<usize>,
    read: Mutex<Vec<usize>>,
}

impl Frames {
    fn new(count: usize) -> Self {
        Self { count, broken: None, read: Mutex::default() }
    }
}

impl Dataset for Frames {}

impl DatasetIterator for Frames {
    fn len(&self) -> usize {
        self.count
    }

    fn get(&self, index: usize) -> Result<Sample> {
        self.read.lock().unwrap_or_else(PoisonError::into_inner).push(index);
        if self.broken == Some(index) {
            return Err(Error::format("truncated"));
        }
        let data = vec![Vector::new(vec![0.0], [1])?.into()];
        Ok(Sample { data, target: self.target(index)? })
    }

    fn target(&self, index: usize) -> Result<Option<Value>> {
        Ok(Some(Category::new((index % 3 + 1) as i64, None).into()))
    }

    fn name(&self, index: usize) -> String {
        format!("frame {index}")
    }

    fn sequence(&self, index: usize) -> Option<usize> {
        Some(index / 3)
    }
}

/// Stops after a number of samples.
struct StopAfter(AtomicU64);

impl Progress for StopAfter {
    fn begin(&self, _: &str, _: Option<u64>, _: Unit) {}

    fn advance(&self, amount: u64) {
        let less = |left: u64| Some(left.saturating_sub(amount));
        self.0.fetch_update(Ordering::Relaxed, Ordering::Relaxed, less).ok();
    }

    fn end(&self) {}

    fn stopped(&self) -> bool {
        self.0.load(Ordering::Relaxed) == 0
    }
}

fn evaluate(
    dataset: &Frames,
    folder: Option<&Path>,
    stop_after: u64,
    problems: &Problems,
) -> Result<Outcome> {
    let progress = StopAfter(AtomicU64::new(stop_after));
    let subject = Subject { learner: "counter".to_owned(), ..Subject::default() };
    let evaluation = Evaluation {
        folder,
        progress: &progress,
        ..Evaluation::new(subject, find("classification")?, problems)
    };
    let mut learners: [Box<dyn AnyLearner>; 2] = [Box::new(Counter::default()), Box::new(Counter::default())];
    let spec = Spec::new("counter", Task::ObjectDetection2d);
    let make = |_: &ParamMap, _| Err(Error::unsupported("making"));
    let entry = Entry::dynamic(spec, &[], <&Vector as Inputs<'_>>::PORTS, Category::OUTPUTS, make);
    evaluation.run(&mut learners, &entry, dataset)
}

fn scratch(name: &str) -> PathBuf {
    let folder = std::env::temp_dir().join(format!("opendr-evaluation-{name}-{}", std::process::id()));
    fs::remove_dir_all(&folder).ok();
    folder
}

#[test]
fn a_sequence_is_one_stream() {
    let outcome = evaluate(&Frames::new(9), None, u64::MAX, &Problems::strict()).unwrap();
    assert_eq!(outcome.report.statistics.get("accuracy"), Some(1.0));
    assert_eq!((outcome.samples, outcome.counted, outcome.complete), (9, 9, true));
}

#[test]
fn resumption_starts_at_a_sequence() {
    let folder = scratch("resume");
    let first = evaluate(&Frames::new(9), Some(&folder), 5, &Problems::strict()).unwrap();
    assert!(!first.complete && first.counted < 9, "{first:?}");
    assert!(first.to_string().contains("not complete"));
    let frames = Frames::new(9);
    let second = evaluate(&frames, Some(&folder), u64::MAX, &Problems::strict()).unwrap();
    assert_eq!(second.report.statistics.get("accuracy"), Some(1.0));
    assert_eq!((second.counted, second.complete), (9, true));
    let read = frames.read.into_inner().unwrap();
    assert_eq!(read.first(), Some(&3), "{read:?}");
    let journal = fs::read(folder.join("predictions.jsonl")).unwrap();
    let third = evaluate(&Frames::new(9), Some(&folder), u64::MAX, &Problems::strict()).unwrap();
    assert_eq!(third.report, second.report);
    assert_eq!(fs::read(folder.join("predictions.jsonl")).unwrap(), journal);
    assert!(evaluate(&Frames::new(6), Some(&folder), u64::MAX, &Problems::strict()).is_err());
    fs::remove_dir_all(folder).unwrap();
}

#[test]
fn broken_samples_end_the_evaluation_or_are_listed() {
    let frames = Frames { broken: Some(4), ..Frames::new(6) };
    let error = evaluate(&frames, None, u64::MAX, &Problems::strict()).unwrap_err();
    assert_eq!(error.to_string(), "frame 4: truncated");
    let outcome = evaluate(&frames, None, u64::MAX, &Problems::skipping()).unwrap();
    assert_eq!((outcome.counted, outcome.skipped, outcome.problems.len()), (5, 1, 1));
}
