//! A policy and the controller that follows its commands, as one controller.

use opendr_engine::environment::{Controller, Space};
use opendr_engine::{Error, Random, Result};
use opendr_kernels::Compute;

use super::{BoxedCommanded, CommandedController as _};
use crate::policy::{ActionMode, Policy, PolicyMemory};

/// A policy that was trained in a [`Commanded`](super::Commanded) environment, with the controller that follows it: acts in the
/// environment itself.
pub struct CommandingPolicy<P> {
    policy: P,
    controller: BoxedCommanded,
    hold: u32,
    /// Steps since the last command, below `hold`.
    held: u32,
    command: Vec<f32>,
    compute: Compute,
    memory: PolicyMemory,
    random: Option<Random>,
}

impl<P: AsRef<Policy>> CommandingPolicy<P> {
    /// Creates a controller in which `policy` commands `controller`, with each command for `hold` steps and the most likely
    /// commands.
    ///
    /// # Errors
    /// `Format` for a policy whose actions are not the controller's commands, and for commands that are held for 0 steps.
    pub fn new(policy: P, controller: BoxedCommanded, hold: u32) -> Result<Self> {
        let actions: &Space = policy.as_ref().action();
        if actions != controller.commands() || hold == 0 {
            return Err(Error::format(format!(
                "a policy with actions {actions}, held for {hold} steps, gives no commands {}; train it again",
                controller.commands()
            )));
        }
        let command = vec![0.0; actions.len()];
        let (compute, memory) = (Compute::single(), PolicyMemory::default());
        Ok(Self { policy, controller, hold, held: 0, command, compute, memory, random: None })
    }

    /// Samples commands, by random numbers that begin with this seed; without a seed it takes the most likely ones.
    pub fn set_sampled(&mut self, seed: Option<u64>) {
        match seed {
            Some(seed) => drop(self.random.get_or_insert_with(|| Random::new(seed))),
            None => self.random = None,
        }
    }
}

impl<P: AsRef<Policy>> Controller for CommandingPolicy<P> {
    fn reset(&mut self) {
        self.held = 0;
        self.controller.reset();
        self.memory.reset(0);
    }

    fn act(&mut self, observation: &[f32], action: &mut [f32]) -> Result<()> {
        if action.len() != self.controller.actions() {
            return Err(Error::invalid_input(format!(
                "room for {} numbers of an action, which has {}",
                action.len(),
                self.controller.actions()
            )));
        }
        if self.held == 0 {
            let acting = self.random.as_mut().map_or(ActionMode::Deterministic, ActionMode::Sampled);
            let policy = self.policy.as_ref();
            policy.act(&self.compute, observation, acting, &mut self.memory, &mut self.command)?;
        }
        self.held = (self.held + 1) % self.hold;
        self.controller.follow(observation, &self.command, action)
    }
}
