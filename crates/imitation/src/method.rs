//! The trait of the methods: a network that predicts chunks of actions, how it learns, and how it acts.

use opendr_engine::learner::Spec;
use opendr_engine::params::Params;
use opendr_engine::{Random, Result};
use opendr_kernels::{AdamOptions, Compute};

use crate::affine::Affine;
use crate::batch::{Batch, Window};

/// Settings of the optimisation that a method prescribes.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Optimisation {
    pub adam: AdamOptions,
    /// Whether the policy acts with a moving average of the parameters, not with the last ones.
    pub averages: bool,
}

/// A step of control: scaled observation in, scaled action out.
pub(crate) struct Acting<'a> {
    pub compute: &'a Compute,
    pub parameters: &'a [f32],
    pub observation: &'a [f32],
    pub action: &'a mut [f32],
}

/// A method of imitation by chunks of actions.
#[allow(private_interfaces, reason = "the methods of this crate only; callers name them as a type argument")]
pub trait ChunkMethod: Clone + Send + Sync + 'static {
    /// Name, task and description of the learner.
    const SPEC: Spec;
    /// Settings of network and training, part of the file of a policy.
    type Config: Params;
    /// Parameters at inference.
    type Params: Params;
    /// Work memory of the training.
    type Tape: Default + Send;
    /// State of a controller: what was observed and predicted before.
    type Memory: Default + Send;

    /// Creates the network for observations and actions of these lengths.
    ///
    /// # Errors
    /// `InvalidParam` for sizes that do not fit together.
    fn new(config: &Self::Config, lengths: [usize; 2]) -> Result<Self>;

    /// Returns the number of parameters.
    fn parameters(&self) -> usize;

    /// Writes initial parameters.
    fn initialise(&self, random: &mut Random, parameters: &mut [f32]);

    /// Returns the window of demonstrations that it trains on.
    fn window(&self) -> Window;

    /// Returns the scaling of rows of demonstrations.
    fn scaling(rows: &[f32], width: usize) -> Affine;

    /// Returns the settings of the optimisation.
    fn optimisation() -> Optimisation;

    /// Returns the loss of a batch, and adds its gradient to `gradients`.
    fn pass(
        &self,
        compute: &Compute,
        parameters: &[f32],
        batch: &Batch,
        random: &mut Random,
        tape: &mut Self::Tape,
        gradients: &mut [f32],
    ) -> f32;

    /// Predicts the next action.
    fn act(&self, params: &Self::Params, memory: &mut Self::Memory, step: Acting<'_>);

    /// Forgets the episode.
    fn reset(memory: &mut Self::Memory);
}
