//! Trains `ssd_default_person` on annotated images and on images that a teacher annotates, from PoseNet's backbone.
//!
//! ```console
//! $ cargo run --release -p opendr-detection --features training --example train_ssd_person -- DATA POSENET CENTERNET \
//!     OUTPUT [FOLDER ...] [PARAMETER=VALUE ...]
//! ```
//!
//! POSENET and CENTERNET are containers from `opendr download`. DATA contains `coco128` (its train split is annotated) and
//! folders of photos without annotations, as each FOLDER is. The images of the evaluation, coco128's val split, `bus.jpg`
//! and `zidane.jpg`, are not in the training set. A further call with the same OUTPUT resumes the training.

use std::path::{Path, PathBuf};

use opendr_datasets::{OpenOptions, Problems};
use opendr_detection::object_detection_2d::single_shot_detector::SingleShotDetectorFitParams;
use opendr_detection::object_detection_2d::{
    CenterNet, CenterNetParams, SingleShotDetector, SingleShotDetectorParams,
};
use opendr_engine::dataset::{Dataset, DatasetIterator, ExternalDataset, Sample};
use opendr_engine::learner::{FitJob, Handle};
use opendr_engine::params::Params;
use opendr_engine::target::{BoundingBoxList, Classes};
use opendr_engine::{Device, Error, Progress, Result, Unit, Value};

/// Images without annotations: folders of DATA, and single files.
const PHOTOS: [&str; 9] = [
    "face_verification",
    "mmpose_samples/coco",
    "mmpose_samples/jhmdb/Frisbee_catch_f_cm_np1_ri_med_0",
    "mmpose_samples/jhmdb/Frisbee_catch_f_cm_np1_ri_med_1",
    "mmpose_samples/jhmdb/Goalkeeper_Training_Day_@_7_catch_f_cm_np1_ri_med_0",
    "mmpose_samples/wflw",
    "mmpose_samples/300w",
    "photos/t1.jpg",
    "photos/astronaut.png",
];

/// The persons of a data set, and photos with the persons that a teacher detects.
struct Persons {
    annotated: Box<dyn DatasetIterator>,
    labelled: Vec<(PathBuf, BoundingBoxList)>,
}

impl Dataset for Persons {}

impl DatasetIterator for Persons {
    fn len(&self) -> usize {
        self.annotated.len() + self.labelled.len()
    }

    fn get(&self, index: usize) -> Result<Sample> {
        let Some(at) = index.checked_sub(self.annotated.len()) else {
            let mut sample = self.annotated.get(index)?;
            if let Some(Value::BoundingBoxList(list)) = &mut sample.target {
                *list = persons(std::mem::take(list));
            }
            return Ok(sample);
        };
        let (path, list) = self.labelled.get(at).ok_or_else(|| Error::not_found("no such sample"))?;
        Ok(Sample { data: vec![opendr_vision::open(path)?.into()], target: Some(list.clone().into()) })
    }

    fn classes(&self) -> Classes {
        ["person"].into_iter().collect()
    }
}

fn persons(mut list: BoundingBoxList) -> BoundingBoxList {
    let classes = std::mem::replace(&mut list.classes, ["person"].into_iter().collect());
    list.boxes.retain(|found| classes.label(&found.name) == Some("person"));
    list.boxes.iter_mut().for_each(|found| found.name = 0.into());
    list
}

fn annotated(data: &Path, split: &str) -> Result<Box<dyn DatasetIterator>> {
    let dataset = ExternalDataset::new(data.join("coco128/object_detection"), "yolo");
    let options = OpenOptions { split: Some(split.to_owned()), ..OpenOptions::default() };
    opendr_datasets::open(&dataset, &options, &Problems::strict())
}

/// Returns CenterNet's detections in the photos. Detections of low scores stay in the list; training ignores them.
fn labelled(photos_at: &[PathBuf], teacher_model: &Path) -> Result<Vec<(PathBuf, BoundingBoxList)>> {
    let params = CenterNetParams { threshold: 0.25, ..CenterNetParams::default() };
    let mut teacher = Handle::<CenterNet>::new(params, Device::Cpu)?;
    teacher.load(teacher_model)?;
    let mut photos = Vec::new();
    for path in photos_at {
        let mut paths = match path.is_dir() {
            true => std::fs::read_dir(path)?.map(|entry| Ok(entry?.path())).collect::<Result<Vec<_>>>()?,
            false => vec![path.clone()],
        };
        paths.retain(|path| path.extension().is_some_and(|end| end == "jpg" || end == "png"));
        paths.sort();
        for path in paths {
            let found = teacher.infer(&opendr_vision::open(&path)?)?;
            photos.push((path, persons(found)));
        }
    }
    Ok(photos)
}

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

fn main() -> Result<()> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [data, posenet, centernet, output, settings @ ..] = &arguments[..] else {
        return Err(Error::invalid_input("give DATA, POSENET, CENTERNET and OUTPUT"));
    };
    let (data, output) = (Path::new(data), Path::new(output));
    let mut params =
        SingleShotDetectorFitParams { backbone_weights: Some(posenet.clone()), ..Default::default() };
    params.layout.aspect_ratios = vec![0.33, 0.6, 1.1];
    params.training.ema = 0.998;
    let mut photos_at: Vec<_> = PHOTOS.map(|name| data.join(name)).into();
    for setting in settings {
        match setting.split_once('=') {
            Some((name, value)) => params.set_text(name, value)?,
            None => photos_at.push(setting.into()),
        }
    }
    let labelled = labelled(&photos_at, Path::new(centernet))?;
    let dataset = Persons { annotated: annotated(data, "train")?, labelled };
    let val_dataset = Persons { annotated: annotated(data, "val")?, labelled: Vec::new() };
    let objects = dataset.labelled.iter().map(|(_, list)| list.boxes.len()).sum::<usize>();
    println!(
        "{} images, in {} of them {objects} persons detected by the teacher",
        dataset.len(),
        dataset.labelled.len()
    );
    let log = output.join("log");
    let job = FitJob { progress: &Lines, resume: true, logging_path: Some(&log), ..FitJob::new(output) };
    let mut detector = Handle::<SingleShotDetector>::new(SingleShotDetectorParams::default(), Device::Auto)?;
    let (dataset, val_dataset): (&dyn DatasetIterator, &dyn DatasetIterator) = (&dataset, &val_dataset);
    let statistics = detector.fit(&params, dataset.into(), Some(val_dataset.into()), &job)?;
    println!("{statistics}");
    Ok(())
}
