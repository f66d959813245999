//! COCO's average precision and recall of boxes, masks and keypoints, equal to pycocotools 2.0.
//!
//! The core ([`Accumulator`]) works on plain numbers: areas, scores and overlaps of each image and class. The metrics
//! [`CocoDetection`], [`CocoSegmentation`] and [`CocoKeypoints`] over targets and [`files`] over COCO's JSON files use
//! it. A number without objects is -1 in pycocotools and absent here. An annotation with the id 0, which pycocotools
//! treats as no match, counts like any other.

mod accumulator;
mod curve;
mod decimal;
mod detection;
pub mod files;
mod keypoints;
mod list_accumulator;
mod matching;
mod overlap;
mod protocol;
mod segmentation;
mod summary;
#[cfg(test)]
mod tests;

pub use accumulator::Accumulator;
pub use detection::{CocoDetection, CocoDetectionParams};
pub use keypoints::{CocoKeypoints, CocoKeypointsParams};
pub use matching::{Detection, GroundTruth};
pub use overlap::{JOINTS, Mask, Person, box_iou, keypoint_similarity};
pub use protocol::{AreaRange, Protocol, RECALLS, THRESHOLDS, recalls, thresholds};
pub use segmentation::CocoSegmentation;
pub use summary::Outcome;
