//! Checks of the calls to an environment.

use opendr_engine::data::Image;
use opendr_engine::environment::{
    Environment, EnvironmentSpec, Info, ResetOptions, Snapshot, StateReader, Step,
};
use opendr_engine::{Error, Result};

use crate::classic_control::{check_length, not_begun};

/// Checks the order of calls (Gymnasium's `OrderEnforcing`), actions, observations and rewards (`PassiveEnvChecker`). Wrong
/// use is an error, not a warning, and leaves the environment unchanged.
#[derive(Debug, Clone)]
pub struct Checked<E> {
    inner: E,
    phase: Phase,
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Phase {
    New,
    Running,
    Over,
    /// A step failed.
    Broken,
}

impl<E: Environment> Checked<E> {
    /// Wraps an environment.
    pub fn new(inner: E) -> Self {
        Self { inner, phase: Phase::New }
    }

    fn check_order(&self) -> Result<()> {
        let spec = self.inner.spec();
        match self.phase {
            Phase::Running => Ok(()),
            Phase::New => Err(not_begun(spec)),
            Phase::Over => Err(Error::invalid_input(format!(
                "the episode of {} is over; call reset before the next step",
                spec.id
            ))),
            Phase::Broken => Err(Error::invalid_input(format!(
                "the last call of {} failed; call reset before the next step",
                spec.id
            ))),
        }
    }

    fn check_observation(&self, observation: &[f32]) -> Result<()> {
        match observation.iter().position(|number| number.is_nan()) {
            None => Ok(()),
            Some(at) => Err(Error::internal(format!(
                "number {at} of the observation of {} is NaN, its equations diverged; check its parameters",
                self.inner.spec().id
            ))),
        }
    }
}

impl<E: Environment> Environment for Checked<E> {
    fn spec(&self) -> &EnvironmentSpec {
        self.inner.spec()
    }

    fn reset(&mut self, seed: Option<u64>, options: &ResetOptions, observation: &mut [f32]) -> Result<Info> {
        check_length(self.inner.spec(), observation)?;
        self.phase = Phase::Broken;
        let info = self.inner.reset(seed, options, observation)?;
        self.check_observation(observation)?;
        self.phase = Phase::Running;
        Ok(info)
    }

    fn step(&mut self, action: &[f32], observation: &mut [f32]) -> Result<Step> {
        self.check_order()?;
        let spec = self.inner.spec();
        check_length(spec, observation)?;
        spec.action.check(action).map_err(|error| error.context(format!("action of {}", spec.id)))?;
        self.phase = Phase::Broken;
        let step = self.inner.step(action, observation)?;
        self.check_observation(observation)?;
        if !step.reward.is_finite() {
            let (id, reward) = (&self.inner.spec().id, step.reward);
            return Err(Error::internal(format!("the reward of {id} is {reward}; check its parameters")));
        }
        self.phase = if step.is_over() { Phase::Over } else { Phase::Running };
        Ok(step)
    }

    fn save_state(&self, snapshot: &mut Snapshot) -> Result<()> {
        if matches!(self.phase, Phase::New | Phase::Broken) {
            self.check_order()?;
        }
        snapshot.push(u64::from(self.phase == Phase::Over));
        self.inner.save_state(snapshot)
    }

    fn load_state(&mut self, state: &mut StateReader<'_>) -> Result<()> {
        self.phase = Phase::Broken;
        let over = state.flag()?;
        self.inner.load_state(state)?;
        self.phase = if over { Phase::Over } else { Phase::Running };
        Ok(())
    }

    fn render(&mut self) -> Result<Option<Image>> {
        if matches!(self.phase, Phase::New | Phase::Broken) {
            self.check_order()?;
        }
        self.inner.render()
    }
}
