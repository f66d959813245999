//! Learners that take a stream in pieces.

use crate::Result;
use crate::learner::Learner;

/// A learner whose input comes in pieces of any length (sound, heart signals): each piece may complete none, one or
/// several targets. The same stream in one piece or in many gives the same targets.
pub trait Streaming: Learner {
    /// Takes the next piece and hands on each target that it completes.
    ///
    /// # Errors
    /// As [`Learner::infer_into`].
    fn push(
        &self,
        state: &mut Self::State,
        piece: Self::Input<'_>,
        emit: &mut dyn FnMut(Self::Target),
    ) -> Result<()>;

    /// The stream is over: hands on what is still pending.
    ///
    /// # Errors
    /// As [`Learner::infer_into`].
    fn flush(&self, state: &mut Self::State, emit: &mut dyn FnMut(Self::Target)) -> Result<()>;
}
