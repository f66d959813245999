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

    /// Writes the deflection of each axis of the rig, each in [-1, 1].
    ///
    /// # Errors
    /// Returns `InvalidInput` for a rig of another number of axes, and `Internal` for a network whose outputs are not finite: clipped to
    /// the axes, they would look like a decision.
    fn choose(&mut self, context: &CameraContext<'_>, action: &mut [f32]) -> Result<()>;
}
