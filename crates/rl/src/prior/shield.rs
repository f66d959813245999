//! Controllers that take over where a policy's action is unsafe.

use std::borrow::BorrowMut;

use opendr_engine::environment::{Controller, EnvironmentSpec, ResetOptions, Snapshot, StateReader};
use opendr_engine::{Error, Result};
use opendr_simulation::vector::{Autoreset, Batch, Interventions, Seeds, VecEnvironment};

use super::BoxedController;

/// Whether a proposed action must not be executed, from observation and action.
pub type Predicate = Box<dyn FnMut(&[f32], &[f32]) -> bool + Send>;

/// Arbitrates between the actions of a policy and a fallback controller (Alshiekh et al., Safe reinforcement learning via
/// shielding, 2018).
pub struct Shield {
    is_unsafe: Predicate,
    fallback: BoxedController,
    action: Vec<f32>,
    steps: u64,
    shielded: u64,
}

impl Shield {
    /// Creates a shield: `fallback` acts where `is_unsafe` says so of observation and proposed action.
    pub fn new(
        is_unsafe: impl FnMut(&[f32], &[f32]) -> bool + Send + 'static,
        fallback: BoxedController,
    ) -> Self {
        Self { is_unsafe: Box::new(is_unsafe), fallback, action: Vec::new(), steps: 0, shielded: 0 }
    }

    /// Returns the share of arbitrated steps in which the fallback acted.
    pub fn shielded_share(&self) -> f64 {
        self.shielded as f64 / self.steps.max(1) as f64
    }

    /// Counts steps from now on.
    pub fn restart_count(&mut self) {
        (self.steps, self.shielded) = (0, 0);
    }

    /// Resets the fallback for another episode.
    pub fn reset(&mut self) {
        self.fallback.reset();
    }

    /// Replaces `action` where it is unsafe, and answers whether it did. The fallback observes every step, so that it knows the
    /// episode when it takes over.
    ///
    /// # Errors
    /// Those of the fallback.
    pub fn arbitrate(&mut self, observation: &[f32], action: &mut [f32]) -> Result<bool> {
        self.action.resize(action.len(), 0.0);
        self.fallback.act(observation, &mut self.action)?;
        let is_unsafe = (self.is_unsafe)(observation, action);
        self.steps += 1;
        match is_unsafe {
            true => {
                self.shielded += 1;
                action.copy_from_slice(&self.action);
            }
            false => self.fallback.executed(action),
        }
        Ok(is_unsafe)
    }
}

/// Environments with a shield each: what learners act in. The executed action goes into their buffers, and
/// [`VecEnvironment::interventions`] flags the steps.
pub struct ShieldedVector<V> {
    inner: V,
    shields: Vec<Shield>,
    observations: Vec<f32>,
    actions: Vec<f32>,
    replaced: Vec<bool>,
}

impl<V: VecEnvironment> ShieldedVector<V> {
    /// Wraps `inner` with one shield for each environment.
    ///
    /// # Errors
    /// `InvalidInput` where there are not as many, or the environments do not reset in the same step.
    pub fn new(inner: V, shields: Vec<Shield>) -> Result<Self> {
        let (spec, count) = (inner.spec(), inner.count());
        if shields.len() != count || inner.autoreset() != Autoreset::SameStep {
            return Err(Error::invalid_input(format!(
                "{} shields for {count} environments with autoreset {:?}; give one for each, and Autoreset::SameStep",
                shields.len(),
                inner.autoreset()
            )));
        }
        let observations = vec![0.0; count * spec.observation.len()];
        let actions = vec![0.0; count * spec.action.len()];
        Ok(Self { shields, observations, actions, replaced: vec![false; count], inner })
    }

    /// Returns the share of steps of all environments in which a fallback acted.
    pub fn shielded_share(&self) -> f64 {
        let sum = |of: fn(&Shield) -> u64| self.shields.iter().map(of).sum::<u64>() as f64;
        sum(|shield| shield.shielded) / sum(|shield| shield.steps).max(1.0)
    }
}

impl<V: VecEnvironment> VecEnvironment for ShieldedVector<V> {
    fn spec(&self) -> &EnvironmentSpec {
        self.inner.spec()
    }

    fn count(&self) -> usize {
        self.inner.count()
    }

    fn autoreset(&self) -> Autoreset {
        self.inner.autoreset()
    }

    fn reset(
        &mut self,
        seeds: Seeds<'_>,
        options: &ResetOptions,
        mask: Option<&[bool]>,
        batch: &mut Batch,
    ) -> Result<()> {
        self.inner.reset(seeds, options, mask, batch)?;
        for (index, shield) in self.shields.iter_mut().enumerate() {
            if mask.is_none_or(|mask| mask[index]) {
                shield.reset();
            }
        }
        self.observations.copy_from_slice(&batch.observations);
        Ok(())
    }

    fn step(&mut self, actions: &[f32], batch: &mut Batch) -> Result<()> {
        if actions.len() != self.actions.len() {
            return Err(Error::invalid_input(format!(
                "{} numbers of actions; give {}",
                actions.len(),
                self.actions.len()
            )));
        }
        self.actions.copy_from_slice(actions);
        let (seen, done) = (self.spec().observation.len(), self.spec().action.len());
        let rows = self.observations.chunks_exact(seen).zip(self.actions.chunks_exact_mut(done));
        for ((shield, replaced), (observation, action)) in
            self.shields.iter_mut().zip(&mut self.replaced).zip(rows)
        {
            *replaced = shield.arbitrate(observation, action)?;
        }
        self.inner.step(&self.actions, batch)?;
        for (index, shield) in self.shields.iter_mut().enumerate() {
            if batch.terminated[index] || batch.truncated[index] {
                shield.reset();
            }
        }
        self.observations.copy_from_slice(&batch.observations);
        Ok(())
    }

    fn interventions(&self) -> Option<Interventions<'_>> {
        Some(Interventions { actions: &self.actions, replaced: &self.replaced })
    }

    fn save_state(&self, snapshot: &mut Snapshot) -> Result<()> {
        for shield in &self.shields {
            snapshot.push(shield.steps);
            snapshot.push(shield.shielded);
            shield.fallback.save_state(snapshot)?;
        }
        snapshot.extend_numbers(self.observations.iter().map(|number| f64::from(*number)));
        self.inner.save_state(snapshot)
    }

    fn load_state(&mut self, state: &mut StateReader<'_>) -> Result<()> {
        for shield in &mut self.shields {
            (shield.steps, shield.shielded) = (state.word()?, state.word()?);
            shield.fallback.load_state(state)?;
        }
        for number in &mut self.observations {
            *number = state.finite()? as f32;
        }
        self.inner.load_state(state)
    }
}

/// A controller whose unsafe actions are replaced by the fallback of a [`Shield`], for evaluation and deployment.
pub struct ShieldedController<C, S = Shield> {
    controller: C,
    shield: S,
}

impl<C: Controller, S: BorrowMut<Shield>> ShieldedController<C, S> {
    /// Puts `controller` under `shield`.
    pub fn new(controller: C, shield: S) -> Self {
        Self { controller, shield }
    }

    /// Returns the share of steps so far in which the fallback acted.
    pub fn shielded_share(&self) -> f64 {
        self.shield.borrow().shielded_share()
    }

    /// Counts steps from now on.
    pub fn restart_count(&mut self) {
        self.shield.borrow_mut().restart_count();
    }
}

impl<C: Controller, S: BorrowMut<Shield>> Controller for ShieldedController<C, S> {
    fn reset(&mut self) {
        self.controller.reset();
        self.shield.borrow_mut().reset();
    }

    fn act(&mut self, observation: &[f32], action: &mut [f32]) -> Result<()> {
        self.controller.act(observation, action)?;
        if self.shield.borrow_mut().arbitrate(observation, action)? {
            self.controller.executed(action);
        }
        Ok(())
    }
}
