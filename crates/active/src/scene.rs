//! Episodes of active perception: a rig, a recogniser, and a subject whose class is known.

use opendr_engine::data::Image;
use opendr_engine::rig::{ViewPose, ViewRig};
use opendr_engine::{Random, Result};

/// An episode generator for training and evaluation: a rig around a subject, and a recogniser in the loop.
pub trait ActiveScene: Send {
    /// Returns the number of classes.
    fn classes(&self) -> usize;

    /// Begins an episode that `random` draws, and returns the true class.
    ///
    /// # Errors
    /// Returns errors of the scene.
    fn begin(&mut self, random: &mut Random) -> Result<usize>;

    /// Returns the rig of this episode.
    fn rig(&mut self) -> &mut dyn ViewRig;

    /// Captures a view, and writes the logarithm of the probability of each class into `evidence`.
    ///
    /// # Errors
    /// Returns errors of the rig and of the recogniser.
    fn view(&mut self, evidence: &mut [f32]) -> Result<&Image>;

    /// Returns the pose from which the subject is recognised best, for the oracle; `None` if it is unknown.
    fn best_pose(&self) -> Option<ViewPose> {
        None
    }
}
