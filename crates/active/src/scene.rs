//! Episodes of active perception: a rig, a recogniser, and a subject whose class is known.

use opendr_engine::data::Image;
use opendr_engine::rig::{ViewPose, ViewRig};
use opendr_engine::{Random, Result};

/// Where a policy is trained and measured: a rig before a subject, and perception in the loop.
pub trait ActiveScene: Send {
    /// Number of classes.
    fn classes(&self) -> usize;

    /// Begins an episode that `random` draws, and returns the true class.
    ///
    /// # Errors
    /// Those of the scene.
    fn begin(&mut self, random: &mut Random) -> Result<usize>;

    /// The rig of this episode.
    fn rig(&mut self) -> &mut dyn ViewRig;

    /// Takes a picture, and writes the logarithm of the probability of each class into `evidence`.
    ///
    /// # Errors
    /// Those of the rig and of the recogniser.
    fn view(&mut self, evidence: &mut [f32]) -> Result<&Image>;

    /// The pose of the rig from which the subject is recognised best, for the oracle; `None` where it is not known.
    fn best_pose(&self) -> Option<ViewPose> {
        None
    }
}
