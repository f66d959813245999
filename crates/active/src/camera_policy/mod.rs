//! Camera policies: what chooses the motion after a view.

mod baselines;
mod greedy;
mod trained;

use opendr_engine::Result;
use opendr_engine::rig::{ViewAxis, ViewPose};

pub use baselines::{OracleBaseline, OrbitBaseline, RandomBaseline, StaticBaseline};
pub use greedy::GreedyPolicy;
pub use trained::TrainedPolicy;

/// Input of a camera policy.
#[derive(Debug, Clone, Copy)]
pub struct CameraContext<'a> {
    /// The observation, as [`Observer`](crate::Observer) writes it.
    pub observation: &'a [f32],
    /// Pose of the camera.
    pub pose: ViewPose,
    /// Axes of the rig.
    pub axes: &'a [ViewAxis],
    /// The best pose, for [`OracleBaseline`] alone.
    pub best: Option<ViewPose>,
}

/// Chooses motions.
pub trait CameraPolicy {
    /// Begins an episode.
    fn begin(&mut self, seed: u64) {
        let _ = seed;
    }

    /// Writes the deflection of each axis, each in [-1, 1].
    ///
    /// # Errors
    /// Returns errors of a network.
    fn choose(&mut self, context: &CameraContext<'_>, action: &mut [f32]) -> Result<()>;
}
