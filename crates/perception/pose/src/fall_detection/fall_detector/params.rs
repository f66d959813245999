//! Parameters of the learner.

use opendr_engine::params::Params;

/// Parameters of [`FallDetector`](super::FallDetector).
#[derive(Debug, Clone, Params)]
pub struct FallDetectorParams {
    /// Time after which a new posture replaces the previous one.
    #[param(default = 0.5, range = 0.0..=60.0, unit = "s", live)]
    pub hold: f32,
    /// Score below which persons are dropped.
    #[param(default = 0.1, range = 0.0..=1.0, live)]
    pub threshold: f32,
    /// Score below which joints are missing.
    #[param(default = 0.1, range = 0.01..=1.0, live)]
    pub keypoint_threshold: f32,
    /// Height of the input of LightweightOpenPose; larger values detect smaller persons. MoveNet has its own size.
    #[param(default = 368, range = 64..=2048, unit = "px", live)]
    pub base_height: usize,
}
