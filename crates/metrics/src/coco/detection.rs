//! COCO's average precision of boxes.

use opendr_engine::params::Params;
use opendr_engine::target::{BoundingBox, BoundingBoxList};
use opendr_engine::{Error, Result};

use super::accumulator::Accumulator;
use super::decimal::f64_box;
use super::matching::{Detection, Truth};
use super::overlap::{box_overlap, check_box};
use super::picture::Pictures;
use super::protocol::Protocol;
use crate::{Metric, Report};

/// What a user may set.
#[derive(Debug, Clone, Params)]
pub struct CocoDetectionParams {
    /// At most this many detections a picture and class are counted, the surest.
    #[param(default = 100, range = 1..=100_000)]
    pub max_detections: u32,
    /// Whether a detection must name the class of the object; without, all classes are one.
    #[param(default = true)]
    pub use_classes: bool,
}

/// Average precision and recall of boxes: pycocotools' `COCOeval(.., "bbox")`.
///
/// An object's area and whether it is a crowd stand in its [`Segment`](opendr_engine::target::Segment); without, it is
/// as big as its box.
#[derive(Debug, Clone)]
pub struct CocoDetection {
    pictures: Pictures,
}

impl Metric for CocoDetection {
    const NAME: &'static str = "coco_detection";
    const ABOUT: &'static str = "average precision and recall of boxes, as pycocotools";
    const NUMBERS: &'static [(&'static str, &'static str)] = super::summary::NUMBERS;
    const RANKS: bool = true;
    type Params = CocoDetectionParams;
    type Prediction = BoundingBoxList;
    type Truth = BoundingBoxList;

    fn new(params: &CocoDetectionParams) -> Result<Self> {
        let accumulator = Accumulator::new(Protocol::objects(params.max_detections));
        let pictures = Pictures { accumulator, classes: Default::default(), use_classes: params.use_classes };
        Ok(Self { pictures })
    }

    fn update(&mut self, at: usize, prediction: &BoundingBoxList, truth: &BoundingBoxList) -> Result<f64> {
        let detected = boxes(prediction, "detection")?;
        let annotated = boxes(truth, "object")?;
        let detections: Vec<_> = scored(prediction, &detected)?;
        let object = |(found, bounds): (&BoundingBox, &[f64; 4])| truth_of(found, bounds[2] * bounds[3]);
        let truths: Vec<_> = truth.boxes.iter().zip(&annotated).map(object).collect();
        let overlap =
            |detection: &[f64; 4], truth: &[f64; 4], crowd: bool| Ok(box_overlap(*detection, *truth, crowd));
        let lists = [prediction, truth];
        self.pictures.add(picture_number(at)?, lists, [&detected, &annotated], &detections, &truths, overlap)
    }

    fn merge(&mut self, other: Self) {
        self.pictures.merge(other.pictures);
    }

    fn finish(&self) -> Report {
        let classes = &self.pictures.classes;
        self.pictures.accumulator.finish(1).report(|class| class.label(classes))
    }
}

/// The number of a picture as it is kept.
pub(super) fn picture_number(at: usize) -> Result<u32> {
    u32::try_from(at).map_err(|_| {
        Error::invalid_input(format!("sample {at} is beyond 2^32 - 1, the last that can be counted"))
    })
}

/// Boxes that are boxes.
pub(super) fn boxes(list: &BoundingBoxList, what: &str) -> Result<Vec<[f64; 4]>> {
    let boxes: Vec<_> = list.boxes.iter().map(f64_box).collect();
    boxes.iter().try_for_each(|bounds| check_box(*bounds, what))?;
    Ok(boxes)
}

/// Scores and areas of detections.
fn scored(list: &BoundingBoxList, boxes: &[[f64; 4]]) -> Result<Vec<Detection>> {
    let detection = |(found, bounds): (&BoundingBox, &[f64; 4])| {
        Ok(Detection { score: checked_score(found.confidence)?, area: bounds[2] * bounds[3] })
    };
    list.boxes.iter().zip(boxes).map(detection).collect()
}

/// A score that is a number.
pub(super) fn checked_score(confidence: f32) -> Result<f64> {
    match confidence.is_nan() {
        false => Ok(f64::from(confidence)),
        true => Err(Error::invalid_input(
            "a detection has a score that is no number; give it one or leave the detection out",
        )),
    }
}

/// An object of `area` square pixels, unless it states its own.
pub(super) fn truth_of(found: &BoundingBox, area: f64) -> Truth {
    let segment = found.segment.as_deref();
    let own = segment.map(|segment| f64::from(segment.area)).filter(|area| *area > 0.0);
    let crowd = segment.is_some_and(|segment| segment.iscrowd);
    Truth { area: own.unwrap_or(area), crowd, ignored: crowd }
}
