//! Policies that can be adapted.

use std::ops::Range;

use opendr_engine::environment::Controller;
use opendr_engine::{Error, Result};
use opendr_kernels::Compute;
use opendr_rl::{ActionMode, Policy, PolicyMemory};

/// A policy with commands that are differentiable in the parameters of its last layer.
pub trait AdaptablePolicy: Clone {
    /// All parameters.
    fn parameters(&self) -> &[f32];

    /// All parameters, to be changed.
    fn parameters_mut(&mut self) -> &mut [f32];

    /// The parameters of the last layer among all.
    fn last_layer(&self) -> Range<usize>;

    /// Outputs of the last layer: those of the commands come first (others, such as deviations, are left as they are).
    fn outputs(&self) -> usize;

    /// Writes the action for an observation, and keeps what [`Self::backward`] needs.
    ///
    /// # Errors
    /// `InvalidInput` for an observation of another space.
    fn act(&mut self, observation: &[f32], action: &mut [f32]) -> Result<()>;

    /// Adds to `gradients` those of [`Self::last_layer`], from the gradient of the action that the last [`Self::act`] wrote; those of
    /// other parameters may be left as they are. The layer is dense, `[inputs, outputs]`, its last row the biases.
    ///
    /// # Errors
    /// `InvalidInput` where a length does not fit.
    fn backward(&mut self, daction: &[f32], gradients: &mut [f32]) -> Result<()>;
}

/// A policy of `opendr-rl` whose actions are numbers, with the memory in which it acts.
#[derive(Debug, Clone)]
pub struct NeuralPolicy {
    policy: Policy,
    compute: Compute,
    memory: PolicyMemory,
}

impl NeuralPolicy {
    /// Creates a policy that acts on the calling thread.
    ///
    /// # Errors
    /// `Unsupported` for a recurrent policy.
    pub fn new(policy: Policy) -> Result<Self> {
        if policy.is_recurrent() {
            return Err(Error::unsupported(
                "a recurrent policy cannot be adapted online; train one without gru_size",
            ));
        }
        Ok(Self { policy, compute: Compute::single(), memory: PolicyMemory::default() })
    }

    /// Returns the policy with its present parameters.
    pub fn policy(&self) -> &Policy {
        &self.policy
    }
}

impl AdaptablePolicy for NeuralPolicy {
    fn parameters(&self) -> &[f32] {
        self.policy.parameters()
    }

    fn parameters_mut(&mut self) -> &mut [f32] {
        self.policy.parameters_mut()
    }

    fn last_layer(&self) -> Range<usize> {
        self.policy.last_layer()
    }

    fn outputs(&self) -> usize {
        self.policy.head().outputs()
    }

    fn act(&mut self, observation: &[f32], action: &mut [f32]) -> Result<()> {
        self.policy.act(&self.compute, observation, ActionMode::Deterministic, &mut self.memory, action)
    }

    fn backward(&mut self, daction: &[f32], gradients: &mut [f32]) -> Result<()> {
        self.policy.last_layer_gradient(daction, &mut self.memory, gradients)
    }
}

/// The frozen policy as a controller.
impl Controller for NeuralPolicy {
    fn act(&mut self, observation: &[f32], action: &mut [f32]) -> Result<()> {
        AdaptablePolicy::act(self, observation, action)
    }
}
