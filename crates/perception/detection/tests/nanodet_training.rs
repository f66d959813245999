//! NanoDet's `fit` from the zoo's weights.

#![cfg(feature = "training")]
#![allow(clippy::unwrap_used, clippy::panic)]

use std::path::{Path, PathBuf};

use opendr_datasets::{OpenOptions, Problems};
use opendr_detection::object_detection_2d::{FrozenPart, Nanodet, NanodetFitParams, NanodetParams};
use opendr_engine::dataset::{Dataset, DatasetIterator, DatasetRef, ExternalDataset, Sample, Subset};
use opendr_engine::learner::{Fit, FitJob, Learner};
use opendr_engine::model::Model;
use opendr_engine::params::Params;
use opendr_engine::target::{BoundingBoxList, Classes, Name};
use opendr_engine::{Device, ErrorKind, Result, Statistics, Value, ValueType};

/// Images of COCO with three classes instead of eighty.
struct Grouped<D> {
    pictures: D,
    classes: Classes,
}

/// COCO's class indices of each class.
const GROUPS: [std::ops::Range<i64>; 3] = [0..1, 1..9, 14..24];

impl<D: DatasetIterator> Grouped<D> {
    fn new(pictures: D) -> Self {
        Self { pictures, classes: ["person", "vehicle", "animal"].into_iter().collect() }
    }
}

impl<D: DatasetIterator> Dataset for Grouped<D> {}

impl<D: DatasetIterator> DatasetIterator for Grouped<D> {
    fn len(&self) -> usize {
        self.pictures.len()
    }

    fn get(&self, index: usize) -> Result<Sample> {
        let mut sample = self.pictures.get(index)?;
        if let Some(Value::BoundingBoxList(list)) = &mut sample.target {
            list.classes = self.classes.clone();
            list.boxes.retain_mut(|found| {
                let Name::Index(index) = found.name else { return false };
                let group = GROUPS.iter().position(|group| group.contains(&index));
                found.name = Name::Index(group.unwrap_or_default() as i64);
                group.is_some()
            });
        }
        Ok(sample)
    }

    fn classes(&self) -> Classes {
        self.classes.clone()
    }
}

/// Returns the zoo's NanoDet from the cache of `opendr`'s tests, and the data folder.
fn zoo() -> Option<(Model, PathBuf)> {
    let (Some(cache), Some(shared)) =
        (std::env::var_os("OPENDR_TEST_CACHE"), std::env::var_os("OPENDR_TEST_DATA"))
    else {
        println!("skipped: no OPENDR_TEST_DATA, or no OPENDR_TEST_CACHE");
        return None;
    };
    let items = PathBuf::from(cache).join("opendr/items/nanodet");
    let containers = std::fs::read_dir(items).into_iter().flatten().flatten().map(|entry| entry.path());
    let model =
        containers.filter_map(|path| Model::open(path).ok()).find(|model| model.classes().len() == 80);
    if model.is_none() {
        println!("skipped: no NanoDet in OPENDR_TEST_CACHE; run the tests of opendr first");
    }
    Some((model?, PathBuf::from(shared).join("data")))
}

fn coco(data: &Path, split: &str) -> Box<dyn DatasetIterator> {
    let options = OpenOptions { split: Some(split.to_owned()), target: Some(ValueType::BoundingBoxList) };
    let folder = ExternalDataset::new(data.join("coco128"), "yolo");
    opendr_datasets::open(&folder, &options, &Problems::strict()).unwrap()
}

struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("opendr-nanodet-{}-{name}", std::process::id()));
        std::fs::remove_dir_all(&path).ok();
        std::fs::create_dir_all(&path).unwrap();
        Self(path)
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        std::fs::remove_dir_all(&self.0).ok();
    }
}

fn params(set: impl FnOnce(&mut NanodetFitParams)) -> NanodetFitParams {
    let mut params = NanodetFitParams::default();
    set(&mut params);
    params
}

fn fit(
    base: Option<&Model>,
    fit_params: &NanodetFitParams,
    dataset: &dyn DatasetIterator,
    val: Option<&dyn DatasetIterator>,
    output: &Path,
) -> Result<Statistics> {
    let job = FitJob { device: Device::Cpu, logging_path: Some(output), ..FitJob::new(output) };
    let val = val.map(DatasetRef::Iterator);
    Nanodet::fit(base, &NanodetParams::default(), fit_params, DatasetRef::Iterator(dataset), val, &job)
}

fn boxes(model: &Path, sample: &Sample) -> BoundingBoxList {
    let learner = Nanodet::load(&Model::open(model).unwrap(), NanodetParams::default(), Device::Cpu).unwrap();
    let Some(Value::Image(image)) = sample.data.first() else { panic!("no image") };
    let mut boxes = BoundingBoxList::default();
    learner.infer_into(&mut (), image, &mut boxes).unwrap();
    boxes
}

#[test]
fn training_at_rate_zero_keeps_predictions() {
    let Some((zoo, data)) = zoo() else { return };
    let pictures = Subset::new(coco(&data, "val"), vec![0, 1]).unwrap();
    let once = params(|params| {
        params.augment = false;
        params.training.lr = 0.0;
        params.training.max_steps = 1;
        params.training.batch_size = 2;
    });
    let folder = Folder::new("same");
    let statistics = fit(Some(&zoo), &once, &pictures, None, &folder.0).unwrap();
    assert_eq!(statistics.scalars.get("steps"), Some(&1.0));
    let trained = folder.0.join("model");
    assert_eq!(Model::open(&trained).unwrap().classes(), zoo.classes());
    let mut found = 0;
    for index in 0..2 {
        let sample = pictures.get(index).unwrap();
        let (before, after) = (boxes(zoo.path(), &sample), boxes(&trained, &sample));
        assert_eq!(before.boxes.len(), after.boxes.len());
        found += before.boxes.len();
        for (before, after) in before.boxes.iter().zip(&after.boxes) {
            assert_eq!(before.name, after.name);
            assert!((before.confidence - after.confidence).abs() < 1e-4);
            let near = before.corners().into_iter().zip(after.corners()).all(|(a, b)| (a - b).abs() < 0.1);
            assert!(near, "{before:?} {after:?}");
        }
    }
    assert!(found > 0);

    // A trained model can be trained further, for other classes too.
    let grouped = Grouped::new(pictures);
    let further = Folder::new("further");
    fit(Some(&Model::open(&trained).unwrap()), &once, &grouped, None, &further.0).unwrap();
    let classes = Model::open(further.0.join("model")).unwrap().classes().clone();
    assert_eq!(classes.iter().collect::<Vec<_>>(), ["person", "vehicle", "animal"]);
}

#[test]
fn unsuitable_data_sets_are_refused() {
    let Some((zoo, data)) = zoo() else { return };
    let few = params(|params| params.training.max_steps = 1);
    let folder = Folder::new("empty");
    let nothing = Grouped::new(Subset::new(coco(&data, "val"), Vec::new()).unwrap());
    let error = fit(Some(&zoo), &few, &nothing, None, &folder.0).unwrap_err();
    assert!(error.kind() == ErrorKind::InvalidInput && error.to_string().contains("empty"), "{error}");

    let folder = Folder::new("classes");
    let unnamed = Grouped { classes: ["person"].into_iter().collect(), pictures: coco(&data, "val") };
    let error = fit(Some(&zoo), &few, &unnamed, None, &folder.0).unwrap_err();
    let text = error.to_string();
    assert!(error.kind() == ErrorKind::InvalidInput && text.contains("data set has 1 classes"), "{text}");
}

/// Compares the mAP at IoU 0.5 of an untrained head with that after training on 64 images.
#[test]
#[ignore = "ten minutes of training"]
fn a_new_head_learns_from_64_pictures() {
    let Some((zoo, data)) = zoo() else { return };
    let train = |count| Grouped::new(Subset::first(coco(&data, "train"), count));
    let val = Grouped::new(coco(&data, "val"));
    let run = |name: &str, count, fit_params: &NanodetFitParams| {
        let folder = Folder::new(name);
        let statistics = fit(Some(&zoo), fit_params, &train(count), Some(&val), &folder.0).unwrap();
        println!("{name}: {statistics:?}");
        statistics
    };
    let map =
        |statistics: &Statistics| statistics.curves.get("val_map50").and_then(|curve| curve.last()).copied();
    let nothing = params(|params| {
        params.training.lr = 0.0;
        params.training.epochs = 1;
    });
    let start = run("start", nothing.training.batch_size, &nothing);
    let chosen = std::env::var("OPENDR_NANODET_FIT").unwrap_or_default();
    let trained = run(
        "trained",
        64,
        &params(|params| {
            params.freeze = FrozenPart::Features;
            params.training.epochs = 20;
            params.training.val_after = 5;
            for pair in chosen.split_whitespace() {
                let (name, value) = pair.split_once('=').unwrap();
                params.set_text(name, value).unwrap();
            }
        }),
    );
    let (start, end) = (map(&start).unwrap(), map(&trained).unwrap());
    println!("mAP50 {start:.3} -> {end:.3}");
    assert!(end - start >= 0.15);
}
