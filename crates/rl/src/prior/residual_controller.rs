//! A prior and the policy that corrects it, as one controller.

use opendr_engine::environment::{Controller, Space};
use opendr_engine::{Error, Random, Result};
use opendr_kernels::Compute;

use super::BoxedController;
use super::residual::{Correction, residual_spaces};
use crate::policy::{ActionMode, Policy, PolicyMemory};

/// A policy that was trained in a [`Residual`](super::Residual) environment, with its prior: acts in the environment itself.
pub struct ResidualController<P> {
    policy: P,
    prior: BoxedController,
    alpha: f32,
    correction: Correction,
    compute: Compute,
    memory: PolicyMemory,
    random: Option<Random>,
    /// Observation, then the prior's action.
    seen: Vec<f32>,
    corrected_by: Vec<f32>,
    /// Whether the corrections are executed without the prior's action.
    alone: bool,
}

/// Observation and action space of the environment inside, from the observations of a policy trained in a
/// [`Residual`](super::Residual) one.
pub(super) fn inner_spaces(policy: &Policy) -> Result<(&Space, &Space)> {
    let (observation, action) = residual_spaces(policy.observation())?;
    if *policy.action() == Correction::new(action)?.space() {
        return Ok((observation, action));
    }
    Err(Error::format(format!(
        "a policy with actions {} corrects no actions {action}: it was not trained in a Residual environment",
        policy.action()
    )))
}

impl<P: AsRef<Policy>> ResidualController<P> {
    /// Creates a controller that adds the most likely corrections of `policy` to `prior`.
    ///
    /// # Errors
    /// `Format` for a policy that was not trained in a [`Residual`](super::Residual) environment.
    pub fn new(policy: P, prior: BoxedController, alpha: f32) -> Result<Self> {
        let (observation, action) = inner_spaces(policy.as_ref())?;
        let seen = vec![0.0; observation.len() + action.len()];
        let (correction, corrected_by) = (Correction::new(action)?, vec![0.0; action.len()]);
        let (compute, memory) = (Compute::single(), PolicyMemory::default());
        let (random, alone) = (None, false);
        Ok(Self { policy, prior, alpha, correction, compute, memory, random, seen, corrected_by, alone })
    }

    /// Executes the corrections around the middle of the bounds, without the prior's action: what the policy does alone.
    #[must_use]
    pub fn without_prior(self) -> Self {
        Self { alone: true, ..self }
    }

    /// Samples corrections, by random numbers that begin with this seed; without a seed it takes the most likely ones.
    pub fn set_sampled(&mut self, seed: Option<u64>) {
        match seed {
            Some(seed) => drop(self.random.get_or_insert_with(|| Random::new(seed))),
            None => self.random = None,
        }
    }
}

impl<P: AsRef<Policy>> Controller for ResidualController<P> {
    fn reset(&mut self) {
        self.prior.reset();
        self.memory.reset(0);
    }

    fn act(&mut self, observation: &[f32], action: &mut [f32]) -> Result<()> {
        let own = self.seen.len() - self.corrected_by.len();
        let (seen, proposal) = self.seen.split_at_mut(own);
        if observation.len() != seen.len() || action.len() != proposal.len() {
            return Err(Error::invalid_input(format!(
                "{} numbers of an observation and room for {} of an action; there are {} and {}",
                observation.len(),
                action.len(),
                seen.len(),
                proposal.len()
            )));
        }
        seen.copy_from_slice(observation);
        self.prior.act(observation, proposal)?;
        let acting = self.random.as_mut().map_or(ActionMode::Deterministic, ActionMode::Sampled);
        let policy = self.policy.as_ref();
        policy.act(&self.compute, &self.seen, acting, &mut self.memory, &mut self.corrected_by)?;
        let proposal = &self.seen[observation.len()..];
        match self.alone {
            true => self.correction.add_to_middle(&self.corrected_by, self.alpha, action),
            false => self.correction.add(proposal, &self.corrected_by, self.alpha, action),
        }
        self.prior.executed(action);
        Ok(())
    }

    fn executed(&mut self, action: &[f32]) {
        self.prior.executed(action);
    }
}
