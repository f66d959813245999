//! `fit` as every surface calls it, with the test learner.

use std::fs;
use std::path::PathBuf;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU32, AtomicU64, Ordering};

use opendr::data::Image;
use opendr::dataset::{Dataset, DatasetIterator, DatasetRef, ExternalDataset, Sample};
use opendr::learner::{AnyLearner, Entry};
use opendr::model::Model;
use opendr::target::{BoundingBox, BoundingBoxList};
use opendr::{Device, ErrorKind, FitData, FitOptions, Fitted, Progress, Result, Silent, Unit};

use crate::models::Models;

/// Sample number `n` has `n` boxes.
struct Boxes(usize);

impl Dataset for Boxes {}

impl DatasetIterator for Boxes {
    fn len(&self) -> usize {
        self.0
    }

    fn get(&self, index: usize) -> Result<Sample> {
        let boxes = vec![BoundingBox::new(0, 0.0, 0.0, 1.0, 1.0, 1.0); index];
        let image = Image::from_rgb8(vec![0; 12], 2, 2)?;
        Ok(Sample { data: vec![image.into()], target: Some(BoundingBoxList::from(boxes).into()) })
    }
}

/// A folder for one test.
struct Place(PathBuf);

impl Place {
    fn new() -> Self {
        static COUNTER: AtomicU32 = AtomicU32::new(0);
        let count = COUNTER.fetch_add(1, Ordering::Relaxed);
        Self(std::env::temp_dir().join(format!("opendr-fit-{}-{count}", std::process::id())))
    }

    fn options(&self, json: &str) -> FitOptions {
        FitOptions { out: Some(self.0.clone()), ..serde_json::from_str(json).unwrap() }
    }
}

impl Drop for Place {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

fn counter() -> (Box<dyn AnyLearner>, &'static Entry) {
    let entry = opendr::registry().find("counter").unwrap();
    (entry.make(&Default::default(), Device::Cpu).unwrap(), entry)
}

fn fit(dataset: &dyn DatasetIterator, options: &FitOptions, progress: &dyn Progress) -> Result<Fitted> {
    let (mut learner, entry) = counter();
    let fitted =
        opendr::fit(learner.as_mut(), entry, DatasetRef::Iterator(dataset).into(), options, progress)?;
    assert_eq!(learner.is_ready(), fitted.model.is_some());
    Ok(fitted)
}

/// Stops after a number of samples, and records notes.
struct StopAfter {
    left: AtomicU64,
    notes: Mutex<Vec<String>>,
}

impl StopAfter {
    fn new(samples: u64) -> Self {
        Self { left: AtomicU64::new(samples), notes: Mutex::default() }
    }
}

impl Progress for StopAfter {
    fn begin(&self, _what: &str, _total: Option<u64>, _unit: Unit) {}

    fn advance(&self, amount: u64) {
        let left = self.left.load(Ordering::Relaxed);
        self.left.store(left.saturating_sub(amount), Ordering::Relaxed);
    }

    fn end(&self) {}

    fn note(&self, line: &str) {
        self.notes.lock().unwrap().push(line.to_owned());
    }

    fn stopped(&self) -> bool {
        self.left.load(Ordering::Relaxed) == 0
    }
}

#[test]
fn model_and_report_lie_in_the_output_folder() {
    let place = Place::new();
    let options = place.options(r#"{"params": {"epochs": 2}, "limit": 4, "name": "boxes"}"#);
    let fitted = fit(&Boxes(9), &options, &Silent).unwrap();
    assert_eq!(fitted.statistics.curves["loss"], [1.5, 1.5]);
    assert_eq!((fitted.samples, fitted.complete, &*fitted.dataset), (4, true, "boxes"));
    let model = Model::open(fitted.model.as_ref().unwrap()).unwrap();
    assert_eq!(model.manifest().learner, "counter");
    let report: serde_json::Value =
        serde_json::from_slice(&fs::read(place.0.join("report.json")).unwrap()).unwrap();
    assert_eq!(report["curves"]["loss"], serde_json::json!([1.5, 1.5]));
    let text = fitted.to_string();
    assert!(
        text.contains("4 samples of boxes") && text.contains("1.500000 to 1.500000 in 2 values"),
        "{text}"
    );
}

#[test]
fn a_stopped_training_resumes() {
    let place = Place::new();
    let mut options = place.options(r#"{"params": {"epochs": 3}}"#);
    let stop = StopAfter::new(7);
    let stopped = fit(&Boxes(5), &options, &stop).unwrap();
    assert_eq!((stopped.complete, stopped.statistics.curves["loss"].len()), (false, 1));
    assert!(stop.notes.lock().unwrap().iter().any(|line| line.starts_with("stopped: ")));
    let error = fit(&Boxes(5), &options, &Silent).unwrap_err();
    assert!(error.kind() == ErrorKind::InvalidInput && error.to_string().contains("is not empty"), "{error}");
    options.resume = true;
    let resumed = fit(&Boxes(5), &options, &Silent).unwrap();
    assert_eq!((resumed.complete, &resumed.statistics.curves["loss"][..]), (true, &[2.0; 3][..]));
}

#[test]
fn val_data_are_measured() {
    let place = Place::new();
    let (mut learner, entry) = counter();
    let (dataset, val) = (Boxes(3), Boxes(9));
    let data =
        FitData { val_dataset: Some(DatasetRef::Iterator(&val)), ..DatasetRef::Iterator(&dataset).into() };
    let fitted = opendr::fit(learner.as_mut(), entry, data, &place.options("{}"), &Silent).unwrap();
    assert_eq!(fitted.statistics.curves["val_boxes"], [4.0]);
}

#[test]
fn a_teacher_with_other_predictions_is_refused() {
    let place = Place::new();
    let (mut learner, entry) = counter();
    let mut teacher = {
        opendr::learner::counter::write_model(&place.0.join("teacher"), 0, &Default::default()).unwrap();
        let (mut teacher, entry) = counter();
        teacher.load(&place.0.join("teacher")).unwrap();
        opendr::teacher("counter", teacher.as_ref(), entry).unwrap()
    };
    teacher.entry = opendr::registry().find("movenet").unwrap();
    let dataset = Boxes(3);
    let data = FitData { teacher: Some(teacher), ..DatasetRef::Iterator(&dataset).into() };
    let options = FitOptions { out: Some(place.0.join("run")), ..FitOptions::default() };
    let error = opendr::fit(learner.as_mut(), entry, data, &options, &Silent).unwrap_err();
    assert!(error.to_string().contains("needs BoundingBoxList"), "{error}");
}

#[test]
fn invalid_options_are_refused_before_anything_is_written() {
    let place = Place::new();
    let refused = |json: &str, wanted: &str| {
        let error = fit(&Boxes(2), &place.options(json), &Silent).unwrap_err();
        assert!(error.to_string().contains(wanted), "{error}");
        assert!(!place.0.exists());
    };
    refused(
        r#"{"params": {"epoch": 3}}"#,
        "fit of CounterLearner has no parameter \"epoch\"; it has epochs, lr",
    );
    refused(r#"{"params": {"epochs": 0}}"#, "out of range");
    refused(r#"{"params": {"epochs": "many"}}"#, "epochs = many should be");
    let entry = opendr::registry().find("yunet").unwrap();
    let error = opendr::check_fit(entry, &Default::default()).unwrap_err();
    assert_eq!(error.kind(), ErrorKind::Unsupported);
    assert!(error.to_string().contains("cannot fit"), "{error}");
    let nothing = fit(&Boxes(0), &place.options("{}"), &Silent).unwrap_err();
    assert!(nothing.to_string().contains("nothing to train on"), "{nothing}");
}

#[test]
fn a_real_teacher_labels_pictures_once() {
    let Some(models) = Models::find() else { return };
    let Some(model) = models.get("nanodet") else { return };
    let place = Place::new();
    let pictures = place.0.join("pictures");
    fs::create_dir_all(&pictures).unwrap();
    for name in ["bus.jpg", "zidane.jpg", "t1.jpg"] {
        fs::copy(models.data("photos").join(name), pictures.join(name)).unwrap();
    }
    let external = ExternalDataset::new(&pictures, "auto");
    let run = |options: &FitOptions| {
        let (mut learner, entry) = counter();
        let teacher = opendr::teacher_with("nanodet", None, Device::Cpu, |params| {
            let mut nanodet = opendr::registry().find("nanodet").unwrap().make(params, Device::Cpu)?;
            nanodet.load(&model)?;
            Ok(nanodet)
        })?;
        let data = FitData { teacher: Some(teacher), ..DatasetRef::External(&external).into() };
        opendr::fit(learner.as_mut(), entry, data, options, &Silent)
    };
    let mut options = FitOptions {
        out: Some(place.0.join("run")),
        teacher_classes: vec!["person".to_owned()],
        ..FitOptions::default()
    };
    let fitted = run(&options).unwrap();
    let persons = fitted.statistics.curves["loss"][0];
    assert!((2..=3).contains(&fitted.samples) && (1.5..=4.0).contains(&persons), "{fitted}");
    let answers = fs::read(place.0.join("run/teacher.jsonl")).unwrap();
    options.resume = true;
    options.teacher_classes = vec!["bus".to_owned()];
    let buses = run(&options).unwrap();
    assert_eq!(buses.samples, 1);
    assert_eq!(fs::read(place.0.join("run/teacher.jsonl")).unwrap(), answers);
}
