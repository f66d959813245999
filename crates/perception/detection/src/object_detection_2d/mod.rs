//! Detection of objects in images: boxes with class labels.

#[cfg(feature = "training")]
mod cells;
mod centernet;
mod detectors;
mod fastest_det;
#[cfg(feature = "training")]
mod frozen_part;
mod gem;
#[cfg(feature = "training")]
mod ground_truth;
mod imported_detector;
mod nanodet;
#[cfg(feature = "training")]
mod selected_classes;
mod seq2seq_nms;
pub mod single_shot_detector;
mod tiled_detection;
mod yolox;

pub use centernet::{CenterNet, CenterNetParams};
pub use detectors::DETECTORS;
pub use fastest_det::{FastestDet, FastestDetParams};
#[cfg(feature = "training")]
pub use frozen_part::FrozenPart;
#[cfg(feature = "training")]
pub use gem::GemFitParams;
pub use gem::{Gem, GemInputs, GemParams, GemTargets};
pub use imported_detector::{
    BoxAngle, BoxFormat, BoxUnit, ImportedDetector, ImportedDetectorParams, MaskOutput, Objectness,
    OutputLayout, RowOrder, ScoreFormat,
};
pub use nanodet::{Nanodet, NanodetParams};
#[cfg(feature = "training")]
pub use nanodet::{NanodetFitParams, NanodetNetwork};
#[cfg(feature = "training")]
pub(crate) use selected_classes::selected_classes;
#[cfg(feature = "training")]
pub use seq2seq_nms::Seq2SeqNmsFitParams;
pub use seq2seq_nms::{NmsVariant, Seq2SeqNms, Seq2SeqNmsInputs, Seq2SeqNmsParams};
pub use single_shot_detector::{SingleShotDetector, SingleShotDetectorParams};
pub use tiled_detection::{TiledDetection, TiledDetectionParams, TiledDetectionState};
pub use yolox::{Yolox, YoloxParams};
#[cfg(feature = "training")]
pub use yolox::{YoloxFitParams, YoloxNetwork, YoloxSize};
