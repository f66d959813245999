//! Training samples with the unsuppressed detections of a detector.

use std::path::Path;
use std::sync::OnceLock;

use opendr_datasets::augment::{Augment as _, Colour, Flip, OtherSamples, Pipeline, RandomResizedCrop};
use opendr_engine::dataset::{Dataset, DatasetIterator, Sample};
use opendr_engine::model::Model;
use opendr_engine::params::ParamMap;
use opendr_engine::target::{BoundingBoxList, Classes};
use opendr_engine::{Device, Error, Random, Result, Value};
use opendr_tiling::{ImageLearner, open_image_learner};

use crate::object_detection_2d::DETECTORS;

/// Converts samples of an image with boxes to samples of the image and its detections, with the boxes as annotation.
pub(super) struct Candidates<'a> {
    dataset: &'a dyn DatasetIterator,
    detector: Box<dyn ImageLearner<BoundingBoxList>>,
    pipeline: Pipeline,
    versions: usize,
    seed: u64,
    /// Cached detections of each sample: the detector dominates the time.
    found: Vec<OnceLock<BoundingBoxList>>,
}

/// Side of an augmented version, in pixels.
const SIDE: usize = 480;
/// Score above which all boxes of the detector are candidates, without suppression.
const LEAST_SCORE: f64 = 0.05;
const MOST_BOXES: i64 = 1000;

impl<'a> Candidates<'a> {
    /// Opens the container of a detector. Each image occurs unchanged and in `versions - 1` versions, cropped, flipped and
    /// recoloured at random.
    ///
    /// # Errors
    /// As [`open_image_learner`].
    pub fn new(
        dataset: &'a dyn DatasetIterator,
        detector: &str,
        versions: usize,
        seed: u64,
        device: Device,
    ) -> Result<Self> {
        let overrides = ParamMap::from([
            ("threshold".to_owned(), LEAST_SCORE.into()),
            ("iou_threshold".to_owned(), 1.0.into()),
            ("max_detections".to_owned(), MOST_BOXES.into()),
            ("max_candidates".to_owned(), MOST_BOXES.into()),
        ]);
        let model = Model::open(Path::new(detector))?;
        let detector = open_image_learner(&model, DETECTORS, &overrides, device)?;
        let crop = RandomResizedCrop {
            width: SIDE,
            height: SIDE,
            min_area: 0.3,
            min_visible: 0.3,
            ..RandomResizedCrop::default()
        };
        let pipeline = Pipeline::default()
            .sometimes(0.8, crop)?
            .sometimes(0.5, Flip::default())?
            .sometimes(0.8, Colour::default())?;
        let count = dataset.len().saturating_mul(versions.max(1));
        let found = (0..count).map(|_| OnceLock::new()).collect();
        Ok(Self { dataset, detector, pipeline, versions: versions.max(1), seed, found })
    }
}

impl Dataset for Candidates<'_> {}

impl DatasetIterator for Candidates<'_> {
    fn len(&self) -> usize {
        self.dataset.len() * self.versions
    }

    fn get(&self, index: usize) -> Result<Sample> {
        let count = self.dataset.len();
        let found = self.found.get(index);
        let found = found.ok_or_else(|| Error::not_found(format!("sample {index} of {}", self.len())))?;
        let mut sample = self.dataset.get(index % count)?;
        if index >= count {
            let mut random = Random::from_key([self.seed, index as u64]);
            self.pipeline.apply(&mut sample, &mut random, &OtherSamples::none())?;
        }
        let [Value::Image(image)] = &sample.data[..] else {
            return Err(Error::invalid_input(
                "`detector` needs samples of one image; omit it for samples that have detections",
            ));
        };
        let list = match found.get() {
            Some(list) => list.clone(),
            None => {
                let mut list = BoundingBoxList { classes: self.detector.classes(), ..Default::default() };
                self.detector.predict_into(image, &mut list)?;
                found.get_or_init(|| list).clone()
            }
        };
        sample.data.push(list.into());
        Ok(sample)
    }

    fn classes(&self) -> Classes {
        self.dataset.classes()
    }

    fn name(&self, index: usize) -> String {
        self.dataset.name(index % self.dataset.len().max(1))
    }
}
