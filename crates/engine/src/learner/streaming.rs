//! Learners that process a stream in pieces.

use crate::Result;
use crate::learner::Learner;

/// A learner whose input comes in pieces of any length (audio, heart signals). A piece may complete none, one or several
/// targets. The targets do not depend on the lengths of the pieces.
pub trait Streaming: Learner {
    /// Processes the next piece and passes each completed target to `emit`.
    ///
    /// # Errors
    /// As [`Learner::infer_into`].
    fn push(
        &self,
        state: &mut Self::State,
        piece: Self::Input<'_>,
        emit: &mut dyn FnMut(Self::Target),
    ) -> Result<()>;

    /// Ends the stream and passes the pending targets to `emit`.
    ///
    /// # Errors
    /// As [`Learner::infer_into`].
    fn flush(&self, state: &mut Self::State, emit: &mut dyn FnMut(Self::Target)) -> Result<()>;
}
