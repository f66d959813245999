//! Recognition of facial expressions.

mod facial_emotion;
mod progressive_spatio_temporal_bln;

pub use facial_emotion::{FacialEmotion, FacialEmotionParams};
#[cfg(feature = "training")]
pub use progressive_spatio_temporal_bln::ProgressiveSpatioTemporalBlnFitParams;
pub use progressive_spatio_temporal_bln::{ProgressiveSpatioTemporalBln, ProgressiveSpatioTemporalBlnParams};
