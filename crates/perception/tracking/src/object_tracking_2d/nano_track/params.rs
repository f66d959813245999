//! Parameters of the learner.

use opendr_engine::params::Params;

/// Parameters of [`NanoTrack`](super::NanoTrack).
#[derive(Debug, Clone, Params)]
pub struct NanoTrackParams {
    /// Weight of the window that penalises positions far from the previous one.
    #[param(default = 0.455, range = 0.0..=1.0, live)]
    pub window_influence: f32,
    /// Penalty of changes of size and aspect ratio.
    #[param(default = 0.138, range = 0.0..=1.0, live)]
    pub penalty: f32,
    /// Rate at which the size of the box follows the network's.
    #[param(default = 0.348, range = 0.0..=1.0, live)]
    pub size_rate: f32,
}
