//! Parameters of nodes.

use opendr_engine::params::Params;
use opendr_ros_bridge::{ClassIds, RosBridge};

/// Parameters of every node besides those of its learner.
#[derive(Debug, Clone, Params)]
pub struct NodeParams {
    /// Form of class ids: by name where one is known, or by index.
    #[param(default = ClassIds::Names, live)]
    pub class_ids: ClassIds,
    /// Whether annotated images are published, while there are subscribers.
    #[param(default = true, live)]
    pub annotate: bool,
    /// JPEG quality of compressed images.
    #[param(default = 90, range = 1..=100, live)]
    pub jpeg_quality: u32,
    /// Maximum difference of the stamps of matching inputs.
    #[param(default = 20.0, range = 0.0..=60_000.0, unit = "ms", live)]
    pub sync_slop_ms: f64,
    /// Maximum duration of an inference before a warning; 0 for no limit.
    #[param(default = 0.0, range = 0.0..=3_600_000.0, unit = "ms", live)]
    pub deadline_ms: f64,
    /// Maximum time without inputs before a node that commands velocities commands zero; 0 for no limit.
    #[param(default = 500.0, range = 0.0..=3_600_000.0, unit = "ms", live)]
    pub timeout_ms: f64,
    /// Whether to use the simulated time of /clock.
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
