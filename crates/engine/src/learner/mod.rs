//! The life cycle of every algorithm: construct, then `download`, `load` or `fit`, then `infer`.
//!
//! An algorithm implements [`Learner`], and [`Fit`], [`Streaming`], [`LearnerRl`] or [`LearnerActive`] where it can;
//! users hold a [`Handle`], surfaces an [`AnyLearner`] made by the [`Registry`].

mod active;
mod any;
mod capability;
mod check;
#[cfg(any(test, feature = "test-learner"))]
pub mod counter;
mod fit;
mod handle;
mod outputs;
mod ports;
mod registry;
mod rl;
mod spec;
mod stream;
mod streaming;

pub use active::LearnerActive;
pub use any::{AnyLearner, AnyStream};
pub use capability::Capabilities;
#[doc(hidden)]
pub use capability::{Probe, ProbeFallback, ProbeFit, ProbeFitIn, ProbeStreaming};
pub use check::{CheckOptions, check_learner};
pub use fit::{Fit, FitJob};
pub use handle::{Handle, empty_learner};
pub use opendr_derive::{Inputs, Targets};
pub use outputs::{Output, Outputs, Targets};
pub use ports::{Inputs, Port, Ports};
pub use registry::{Entry, Registry};
pub use rl::LearnerRl;
pub use spec::Spec;
pub use stream::Stream;
pub use streaming::Streaming;

use crate::model::Model;
use crate::params::Params;
use crate::target::Classes;
use crate::{Device, Result};

/// An algorithm that answers targets to data.
///
/// The learner itself never changes while it infers: what one stream (camera, topic, thread) remembers is its
/// [`Learner::State`], so one learner serves many streams at once.
pub trait Learner: Sized + Send + Sync + 'static {
    /// Name, task, class.
    const SPEC: Spec;
    /// What a user may set.
    type Params: Params;
    /// What it takes: `&'a Image`, or a `#[derive(Inputs)]` struct of named ports.
    type Input<'a>: Inputs<'a>;
    /// What it answers: a target, or a `#[derive(Targets)]` struct of named outputs.
    type Target: Targets;
    /// What one stream remembers: tracks, history, windows. `()` when nothing.
    type State: Default + Send + 'static;

    /// Makes a learner of a model container.
    ///
    /// # Errors
    /// `Format` or `Integrity` when the container is not one of this learner, `Device` when the device is not there.
    fn load(model: &Model, params: Self::Params, device: Device) -> Result<Self>;

    /// The parameters in force.
    fn params(&self) -> &Self::Params;

    /// The parameters in force, to change those that are `live`.
    fn params_mut(&mut self) -> &mut Self::Params;

    /// What class numbers mean.
    fn classes(&self) -> Classes {
        Classes::default()
    }

    /// Answers `target` to `input`. Memory of `target` is used again; after the first frames nothing is allocated.
    ///
    /// Time stamp and frame id of the target are set by the caller ([`Handle`], [`Stream`]).
    ///
    /// # Errors
    /// `InvalidInput` when the input does not fit.
    fn infer_into(
        &self,
        state: &mut Self::State,
        input: Self::Input<'_>,
        target: &mut Self::Target,
    ) -> Result<()>;

    /// Answers several inputs of one stream, in order. Override where a batch is faster than a loop.
    ///
    /// # Errors
    /// As [`Learner::infer_into`], for the first input that fails.
    fn infer_batch(
        &self,
        state: &mut Self::State,
        inputs: Vec<Self::Input<'_>>,
    ) -> Result<Vec<Self::Target>> {
        let one = |input: Self::Input<'_>| {
            let mut target = Self::Target::default();
            target.set_header(input.header());
            self.infer_into(state, input, &mut target).map(|()| target)
        };
        inputs.into_iter().map(one).collect()
    }
}

#[cfg(test)]
mod tests;
