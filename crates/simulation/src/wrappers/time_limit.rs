//! Truncation of episodes after a number of steps.

use opendr_engine::data::Image;
use opendr_engine::environment::{
    Environment, EnvironmentSpec, Info, ResetOptions, Snapshot, StateReader, Step,
};
use opendr_engine::{Error, Result};

/// Truncates an episode after the `max_episode_steps` of the spec. Truncation is not termination: the last
/// state still has a value.
#[derive(Debug, Clone)]
pub struct TimeLimit<E> {
    inner: E,
    spec: EnvironmentSpec,
    elapsed: u32,
}

impl<E: Environment> TimeLimit<E> {
    /// Wraps an environment with a limit that replaces the one of its spec.
    ///
    /// # Errors
    /// `InvalidParam` when `max_episode_steps` is 0.
    pub fn new(inner: E, max_episode_steps: u32) -> Result<Self> {
        if max_episode_steps == 0 {
            return Err(Error::invalid_param("max_episode_steps is 0; give at least 1"));
        }
        let spec = inner.spec().clone().with_max_episode_steps(max_episode_steps);
        Ok(Self { inner, spec, elapsed: 0 })
    }
}

impl<E: Environment> Environment for TimeLimit<E> {
    fn spec(&self) -> &EnvironmentSpec {
        &self.spec
    }

    fn reset(&mut self, seed: Option<u64>, options: &ResetOptions, observation: &mut [f32]) -> Result<Info> {
        self.elapsed = 0;
        self.inner.reset(seed, options, observation)
    }

    fn step(&mut self, action: &[f32], observation: &mut [f32]) -> Result<Step> {
        let mut step = self.inner.step(action, observation)?;
        self.elapsed = self.elapsed.saturating_add(1);
        step.truncated |= self.spec.max_episode_steps.is_some_and(|limit| self.elapsed >= limit);
        Ok(step)
    }

    fn save_state(&self, snapshot: &mut Snapshot) -> Result<()> {
        snapshot.push(u64::from(self.elapsed));
        self.inner.save_state(snapshot)
    }

    fn load_state(&mut self, state: &mut StateReader<'_>) -> Result<()> {
        self.elapsed = state.count(u32::MAX as usize)? as u32;
        self.inner.load_state(state)
    }

    fn render(&mut self) -> Result<Option<Image>> {
        self.inner.render()
    }
}
