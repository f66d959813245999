//! What a user sets of any node.

use opendr_engine::params::Params;
use opendr_ros_bridge::{ClassIds, RosBridge};

/// The parameters that every node has besides those of its learner.
#[derive(Debug, Clone, Params)]
pub struct NodeParams {
    /// How classes are told: by name where one is known, or by number.
    #[param(default = ClassIds::Names, live)]
    pub class_ids: ClassIds,
    /// Whether a picture with what was found is drawn, while somebody listens.
    #[param(default = true, live)]
    pub annotate: bool,
    /// Quality of compressed pictures.
    #[param(default = 90, range = 1..=100, live)]
    pub jpeg_quality: u32,
    /// How far the stamps of inputs that belong together may lie apart.
    #[param(default = 20.0, range = 0.0..=60_000.0, unit = "ms", live)]
    pub sync_slop_ms: f64,
    /// How long an inference may take before it is warned of; 0 for any time.
    #[param(default = 0.0, range = 0.0..=3_600_000.0, unit = "ms", live)]
    pub deadline_ms: f64,
    /// How long inputs may stay away before a node that commands velocities commands 0; 0 for any time.
    #[param(default = 500.0, range = 0.0..=3_600_000.0, unit = "ms", live)]
    pub timeout_ms: f64,
    /// Whether the time of /clock is the time.
    #[param(default = false)]
    pub use_sim_time: bool,
}

impl NodeParams {
    pub(super) fn bridge(&self) -> RosBridge {
        RosBridge {
            class_ids: self.class_ids,
            jpeg_quality: u8::try_from(self.jpeg_quality).unwrap_or(u8::MAX),
        }
    }
}
