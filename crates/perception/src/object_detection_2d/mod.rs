//! Boxes with classes in a picture.

mod centernet;
mod gem;
mod nanodet;
mod seq2seq_nms;
pub mod single_shot_detector;
mod tiled_detection;
#[cfg(feature = "training")]
mod wanted_classes;

pub use centernet::{CenterNet, CenterNetParams};
#[cfg(feature = "training")]
pub use gem::GemFitParams;
pub use gem::{Gem, GemInputs, GemParams, GemTargets};
pub use nanodet::{Nanodet, NanodetParams};
#[cfg(feature = "training")]
pub use nanodet::{NanodetFitParams, NanodetFreeze, NanodetNetwork};
use opendr_engine::target::{BoundingBox, BoundingBoxList, Classes};
use opendr_vision::InputGeometry;
#[cfg(feature = "training")]
pub use seq2seq_nms::Seq2SeqNmsFitParams;
pub use seq2seq_nms::{NmsVariant, Seq2SeqNms, Seq2SeqNmsInputs, Seq2SeqNmsParams};
pub use single_shot_detector::{SingleShotDetector, SingleShotDetectorParams};
pub use tiled_detection::{TiledDetection, TiledDetectionParams, TiledDetectionState};
#[cfg(feature = "training")]
pub(crate) use wanted_classes::wanted_classes;

use crate::suppression::Candidate;

/// Replaces the boxes of `list` by `candidates`, brought back to the picture's pixels and cut at its border.
///
/// Candidates that lie outside the picture altogether are left out.
pub(crate) fn boxes_from_candidates(
    list: &mut BoundingBoxList,
    candidates: &[Candidate],
    geometry: &InputGeometry,
    classes: &Classes,
) {
    list.boxes.clear();
    list.classes.clone_from(classes);
    list.boxes.extend(candidates.iter().filter_map(|candidate| {
        let corners = geometry.image_box_from_input(candidate.corners);
        let inside = corners[2] > corners[0] && corners[3] > corners[1];
        inside.then(|| BoundingBox::from_corners(i64::from(candidate.class), corners, candidate.score))
    }));
}
