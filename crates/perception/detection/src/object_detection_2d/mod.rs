//! Boxes with classes in a picture.

mod centernet;
mod detectors;
mod gem;
mod nanodet;
mod seq2seq_nms;
pub mod single_shot_detector;
mod tiled_detection;
#[cfg(feature = "training")]
mod wanted_classes;

pub use centernet::{CenterNet, CenterNetParams};
pub use detectors::DETECTORS;
#[cfg(feature = "training")]
pub use gem::GemFitParams;
pub use gem::{Gem, GemInputs, GemParams, GemTargets};
pub use nanodet::{Nanodet, NanodetParams};
#[cfg(feature = "training")]
pub use nanodet::{NanodetFitParams, NanodetFreeze, NanodetNetwork};
#[cfg(feature = "training")]
pub use seq2seq_nms::Seq2SeqNmsFitParams;
pub use seq2seq_nms::{NmsVariant, Seq2SeqNms, Seq2SeqNmsInputs, Seq2SeqNmsParams};
pub use single_shot_detector::{SingleShotDetector, SingleShotDetectorParams};
pub use tiled_detection::{TiledDetection, TiledDetectionParams, TiledDetectionState};
#[cfg(feature = "training")]
pub(crate) use wanted_classes::wanted_classes;
