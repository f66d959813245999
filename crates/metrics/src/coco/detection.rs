//! COCO's average precision of boxes.

use opendr_engine::params::Params;
use opendr_engine::target::{BoundingBox, BoundingBoxList};
use opendr_engine::{Error, Result};

use super::accumulator::Accumulator;
use super::decimal::f64_box;
use super::list_accumulator::ListAccumulator;
use super::matching::{Detection, GroundTruth};
use super::overlap::{box_iou, check_box};
use super::protocol::Protocol;
use crate::{Metric, Report};

/// Parameters of [`CocoDetection`] and [`CocoSegmentation`](super::CocoSegmentation).
#[derive(Debug, Clone, Params)]
pub struct CocoDetectionParams {
    /// Maximum number of detections per image and class; those with the highest scores count.
    #[param(default = 100, range = 1..=100_000)]
    pub max_detections: u32,
    /// Whether detections match only objects of their class; otherwise all classes count as one.
    #[param(default = true)]
    pub use_classes: bool,
}

/// Average precision and recall of boxes: pycocotools' `COCOeval(.., "bbox")`.
///
/// Area and crowd flag of an object are those of its [`Segment`](opendr_engine::target::Segment); without one, the area
/// is that of the box.
#[derive(Debug, Clone)]
pub struct CocoDetection {
    lists: ListAccumulator,
}

impl Metric for CocoDetection {
    const NAME: &'static str = "coco_detection";
    const ABOUT: &'static str = "average precision and recall of boxes, as pycocotools";
    const NUMBERS: &'static [(&'static str, &'static str)] = super::summary::NUMBERS;
    const IS_RANKING: bool = true;
    type Params = CocoDetectionParams;
    type Prediction = BoundingBoxList;
    type GroundTruth = BoundingBoxList;

    fn new(params: &CocoDetectionParams) -> Result<Self> {
        let accumulator = Accumulator::new(Protocol::objects(params.max_detections));
        let lists =
            ListAccumulator { accumulator, classes: Default::default(), use_classes: params.use_classes };
        Ok(Self { lists })
    }

    fn update(
        &mut self,
        at: usize,
        prediction: &BoundingBoxList,
        ground_truth: &BoundingBoxList,
    ) -> Result<f64> {
        let detected = boxes(prediction, "detection")?;
        let annotated = boxes(ground_truth, "object")?;
        let detections: Vec<_> = scored(prediction, &detected)?;
        let to_truth = |(object, bounds): (&BoundingBox, &[f64; 4])| truth_of(object, bounds[2] * bounds[3]);
        let ground_truths: Vec<_> = ground_truth.boxes.iter().zip(&annotated).map(to_truth).collect();
        let overlap = |detection: &[f64; 4], ground_truth: &[f64; 4], crowd: bool| {
            Ok(box_iou(*detection, *ground_truth, crowd))
        };
        let lists = [prediction, ground_truth];
        self.lists.add(image_index(at)?, lists, [&detected, &annotated], &detections, &ground_truths, overlap)
    }

    fn merge(&mut self, other: Self) {
        self.lists.merge(other.lists);
    }

    fn finish(&self) -> Report {
        let classes = &self.lists.classes;
        self.lists.accumulator.finish(1).report(|class| class.label(classes))
    }
}

/// Converts the index of a sample to that of an image.
pub(super) fn image_index(at: usize) -> Result<u32> {
    u32::try_from(at).map_err(|_| {
        Error::invalid_input(format!("sample index {at} is above 2^32 - 1, the largest supported"))
    })
}

/// Returns the boxes of a list, after a check of each.
pub(super) fn boxes(list: &BoundingBoxList, what: &str) -> Result<Vec<[f64; 4]>> {
    let boxes: Vec<_> = list.boxes.iter().map(f64_box).collect();
    boxes.iter().try_for_each(|bounds| check_box(*bounds, what))?;
    Ok(boxes)
}

/// Returns scores and areas of detections.
fn scored(list: &BoundingBoxList, boxes: &[[f64; 4]]) -> Result<Vec<Detection>> {
    let detection = |(object, bounds): (&BoundingBox, &[f64; 4])| {
        Ok(Detection { score: checked_score(object.confidence)?, area: bounds[2] * bounds[3] })
    };
    list.boxes.iter().zip(boxes).map(detection).collect()
}

/// Returns a score that is not NaN.
pub(super) fn checked_score(confidence: f32) -> Result<f64> {
    match confidence.is_nan() {
        false => Ok(f64::from(confidence)),
        true => Err(Error::invalid_input(
            "the score of a detection is NaN; give a number or remove the detection",
        )),
    }
}

/// Creates an object of `area` square pixels, unless it has its own area.
pub(super) fn truth_of(object: &BoundingBox, area: f64) -> GroundTruth {
    let segment = object.segment.as_deref();
    let own = segment.map(|segment| f64::from(segment.area)).filter(|area| *area > 0.0);
    let crowd = segment.is_some_and(|segment| segment.iscrowd);
    GroundTruth { area: own.unwrap_or(area), crowd, ignored: crowd }
}
