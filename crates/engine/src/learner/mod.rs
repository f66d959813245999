//! Learners: construction, then `download`, `load` or `fit`, then `infer`.
//!
//! An algorithm implements [`Learner`], and [`Fit`], [`Streaming`], [`LearnerRl`] or [`LearnerActive`] if it can. Users
//! hold a [`Handle`]; surfaces hold an [`AnyLearner`] from the [`Registry`].

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
mod training_group;

pub use active::LearnerActive;
pub use any::{AnyLearner, AnyStream};
pub use capability::Capabilities;
#[doc(hidden)]
pub use capability::{Probe, ProbeFallback, ProbeFit, ProbeFitActive, ProbeFitIn, ProbeStreaming};
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
pub use training_group::TrainingGroup;

use crate::model::Model;
use crate::params::{ParamMap, Params};
use crate::target::Classes;
use crate::{Device, Result};

/// An algorithm that predicts targets from data.
///
/// A learner does not change during inference. Each stream (camera, topic, thread) has its own [`Learner::State`], so one
/// learner serves many streams at once.
pub trait Learner: Sized + Send + Sync + 'static {
    /// Name, task and class name.
    const SPEC: Spec;
    /// Parameters of the inference.
    type Params: Params;
    /// Input: `&'a Image`, or a `#[derive(Inputs)]` struct of named ports.
    type Input<'a>: Inputs<'a>;
    /// Prediction: a target, or a `#[derive(Targets)]` struct of named outputs.
    type Target: Targets;
    /// State of one stream: tracks, history, windows; `()` for none.
    type State: Default + Send + 'static;

    /// Creates a learner from a model container.
    ///
    /// # Errors
    /// Returns `Format` or `Integrity` if the container does not fit this learner, `Device` if the device is not available.
    fn load(model: &Model, params: Self::Params, device: Device) -> Result<Self>;

    /// Returns the current parameters.
    fn params(&self) -> &Self::Params;

    /// Returns the current parameters, to modify those that are `live`.
    fn params_mut(&mut self) -> &mut Self::Params;

    /// Returns the classes that the learner predicts.
    fn classes(&self) -> Classes {
        Classes::default()
    }

    /// Returns parameters of its task's metric without which the predictions cannot be compared, such as the alignment of depths of
    /// unknown scale. Those that the user gives override them.
    fn metric_params(&self) -> ParamMap {
        ParamMap::new()
    }

    /// Writes the prediction for `input` into `target`. The memory of `target` is reused; after the first frames nothing is
    /// allocated.
    ///
    /// The caller ([`Handle`], [`Stream`]) sets time stamp and frame id of the target.
    ///
    /// # Errors
    /// Returns `InvalidInput` if the input does not fit the learner.
    fn infer_into(
        &self,
        state: &mut Self::State,
        input: Self::Input<'_>,
        target: &mut Self::Target,
    ) -> Result<()>;

    /// Returns the predictions for several inputs of one stream, in order. Learners override it if a batch is faster than a
    /// loop.
    ///
    /// # Errors
    /// Returns the error of the first input that fails, as [`Learner::infer_into`].
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
