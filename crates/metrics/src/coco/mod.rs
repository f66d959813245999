//! COCO's average precision and recall of boxes, masks and key points, equal to pycocotools 2.0.
//!
//! The core ([`Accumulator`]) works on plain numbers: of each picture and class, areas, scores and overlaps. On it stand
//! the metrics [`CocoDetection`], [`CocoSegmentation`] and [`CocoKeypoints`] over targets, and [`files`] over COCO's
//! JSON files. What has nothing to count is -1 in pycocotools and absent here; an annotation whose number is 0, which
//! pycocotools takes for no match at all, counts like any other.

mod accumulator;
mod curve;
mod decimal;
mod detection;
pub mod files;
mod keypoints;
mod matching;
mod overlap;
mod picture;
mod protocol;
mod segmentation;
mod summary;
#[cfg(test)]
mod tests;

pub use accumulator::Accumulator;
pub use detection::{CocoDetection, CocoDetectionParams};
pub use keypoints::{CocoKeypoints, CocoKeypointsParams};
pub use matching::{Detection, Truth};
pub use overlap::{JOINTS, Mask, Person, box_overlap, keypoint_similarity};
pub use protocol::{AreaRange, Protocol, RECALLS, THRESHOLDS, recalls, thresholds};
pub use segmentation::CocoSegmentation;
pub use summary::Outcome;
