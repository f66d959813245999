//! Target types, the predictions of learners and the annotations of data sets. One file per type.
//!
//! `{}` writes a target as OpenDR's text; `{:#}` writes a readable line per item, each with a line feed.
//! `docs/json.md` lists the JSON of each type.

use std::fmt;

use crate::Datum;
use crate::numpy_text::{Number, array_str};

/// A type that annotates a datum.
///
/// Types that are annotations only implement this trait and not [`Target`].
pub trait BaseTarget: Datum + fmt::Debug + fmt::Display {}

/// A type that is both an annotation and a prediction of a learner.
pub trait Target: BaseTarget {
    /// Returns the score: that of the whole, or the mean over a list (0 if it is empty); `None` if there is none.
    fn confidence(&self) -> Option<f32>;

    /// Returns the proposed camera motion for a better view.
    fn action(&self) -> Option<&Action>;

    /// Sets the proposed camera motion.
    fn set_action(&mut self, action: Option<Action>);
}

/// Implements [`Target`] for a type with a field `action`; the closure returns the score.
macro_rules! target {
    ($type:ty, |$target:pat_param| $confidence:expr) => {
        impl $crate::target::BaseTarget for $type {}

        impl $crate::target::Target for $type {
            fn confidence(&self) -> Option<f32> {
                let $target = self;
                $confidence
            }

            fn action(&self) -> Option<&$crate::target::Action> {
                self.action.as_ref()
            }

            fn set_action(&mut self, action: Option<$crate::target::Action>) {
                self.action = action;
            }
        }
    };
}

mod action;
mod bounding_box;
mod bounding_box_3d;
mod category;
mod classes;
mod convert;
mod heatmap;
mod json_number;
mod keypoint;
mod lidar_box;
mod name;
mod odometry;
mod pose;
mod rl_target;
mod rle;
mod segment;
mod skeleton;
mod speech_command;
mod text_region;
mod tracking_annotation;
mod tracking_annotation_3d;
mod transcription;

pub use action::{Action, ActionBase};
pub use bounding_box::{BoundingBox, BoundingBoxList};
pub use bounding_box_3d::{BoundingBox3D, BoundingBox3DList};
pub use category::Category;
pub use classes::Classes;
pub use convert::{CocoAnnotation, KittiColumns};
pub use heatmap::{Heatmap, HeatmapValues};
pub use keypoint::Keypoint;
pub use lidar_box::LidarBox;
pub use name::Name;
pub use odometry::{Odometry, RigidPose};
pub use pose::{Pose, PoseList};
pub use rl_target::RlTarget;
pub use rle::Rle;
pub use segment::{Segment, Segmentation};
pub use skeleton::Skeleton;
pub use speech_command::SpeechCommand;
pub use text_region::{TextRegion, TextRegionList};
pub use tracking_annotation::{TrackingAnnotation, TrackingAnnotationList};
pub use tracking_annotation_3d::{TrackingAnnotation3D, TrackingAnnotation3DList};
pub use transcription::{BaseTranscription, VoskTranscription, WhisperSegment, WhisperTranscription};

/// Returns the mean of the scores, 0 if there are none.
fn mean(scores: impl ExactSizeIterator<Item = f32>) -> f32 {
    let count = scores.len().max(1);
    scores.sum::<f32>() / count as f32
}

/// Writes a two-dimensional array as NumPy prints it.
fn write_rows<const N: usize>(rows: &[[f32; N]], f: &mut fmt::Formatter<'_>) -> fmt::Result {
    f.write_str(&array_str(&[rows.len(), N], &|at| Number::F32(rows[at / N][at % N])))
}
