//! Metrics of perception and reinforcement learning, as streaming accumulators.
//!
//! A [`Metric`] adds samples one by one (`update`), keeps little of each, merges with accumulators of other threads, and
//! returns a [`Report`]: numbers, tables, and figures to draw. The numbers equal those of the reference tools that papers
//! cite; each file names its tool. There is one file per metric:
//!
//! * detection and poses: [`CocoDetection`], [`CocoSegmentation`], [`CocoKeypoints`], [`Voc`], [`Kitti`], [`Keypoints`];
//! * tracking: [`ClearMot`], [`Hota`], [`Identity`], [`Tracking3d`];
//! * segmentation and depth: [`Segmentation`], [`Panoptic`], [`Depth`];
//! * classification and retrieval: [`Classification`], [`Roc`], [`Verification`], [`Reidentification`], [`Regression`];
//! * speech: [`Transcription`]; reinforcement learning: [`Success`].
//!
//! [`metrics`] and [`find`] list them by name, as the surfaces do. Running a learner over a data set is the task of
//! `opendr-evaluation`; drawing the figures is not part of this crate either. [`Metric`] is the type to begin with.
//!
//! ```
//! use opendr_engine::target::Category;
//! use opendr_metrics::{Classification, ClassificationParams, Metric};
//!
//! let mut metric = Classification::new(&ClassificationParams::default())?;
//! for (index, (predicted, annotated)) in [(0, 0), (1, 1), (1, 0), (1, 1)].into_iter().enumerate() {
//!     metric.update(index, &Category::new(predicted, None), &Category::new(annotated, None))?;
//! }
//! assert_eq!(metric.finish().statistics.get("accuracy"), Some(0.75));
//! # Ok::<_, opendr_engine::Error>(())
//! ```

mod any;
mod average;
mod calibration;
mod class_key;
mod classification;
mod clear_mot;
pub mod coco;
mod depth;
mod edit_distance;
mod generated;
mod hota;
mod identity;
mod keypoints;
mod kitti;
mod metric;
mod mot_challenge;
mod numbers;
mod panoptic;
mod precision_recall;
mod registry;
mod regression;
mod reidentification;
mod report;
mod roc;
mod segmentation;
mod sequences;
mod success;
mod text;
mod tracking_3d;
mod tracking_frame;
mod transcription;
mod verification;
mod voc;

pub use any::{AnyMetric, MetricEntry};
pub use calibration::{Calibration, CalibrationBin};
pub use classification::{Classification, ClassificationParams};
pub use clear_mot::{ClearMot, ClearMotCounts, TrackMatchingParams};
pub use coco::{CocoDetection, CocoKeypoints, CocoSegmentation};
pub use depth::{
    AlignedDepth, Depth, DepthAlignment, DepthErrors, DepthParams, DepthQuantity, DisparityErrors,
};
pub use edit_distance::EditCounts;
pub use hota::{Hota, HotaCounts, HotaParams, HotaScores};
pub use identity::{Identity, IdentityCounts};
pub use keypoints::{Keypoints, KeypointsParams, PoseSize};
pub use kitti::{Kitti, KittiClass, KittiDifficulty, KittiObject, KittiOverlap, KittiScore};
pub use metric::Metric;
pub use mot_challenge::MotRules;
pub use numbers::undocumented;
pub use opendr_engine::overlap::{RotatedRectangle, UprightBox3D, box_ioa, box_iou};
pub use panoptic::{LABEL_DIVISOR, Panoptic, PanopticCounts, PanopticMap, PanopticParams, PanopticSegment};
pub use precision_recall::{ClassCounts, ClassScore, ClassScores, PrecisionRecall, ZeroDivision};
pub use registry::{find, metrics};
pub use regression::{Regression, Residuals};
pub use reidentification::{Reidentification, ReidentificationParams, Retrieval, Subject, VectorDistance};
pub use report::{Bars, Curves, Figure, Line, Matrix, Report, Table};
pub use roc::{Roc, RocCurve, RocParams, RocPoint};
pub use segmentation::{ClassPixels, Segmentation, SegmentationParams, SegmentationScores};
pub use success::{
    Episode, Interval, Success, SuccessParams, bootstrap_interval, interquartile_mean, wilson_interval,
};
pub use text::{Text, TextParams};
pub use tracking_3d::{Tracking3d, Tracking3dParams};
pub use tracking_frame::TrackingFrame;
pub use transcription::{Transcription, TranscriptionParams, split_words};
pub use verification::{FoldAccuracy, Verification, VerificationParams};
pub use voc::{Voc, VocParams};
