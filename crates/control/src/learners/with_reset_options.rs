//! A wrapper that adds options to every reset.

use opendr_engine::Result;
use opendr_engine::data::Image;
use opendr_engine::environment::{
    Environment, EnvironmentSpec, Info, ResetOptions, Snapshot, StateReader, Step,
};

/// An environment whose resets have further options, unless the caller sets them.
#[derive(Debug, Clone)]
pub struct WithResetOptions<E> {
    inner: E,
    options: ResetOptions,
}

impl<E: Environment> WithResetOptions<E> {
    /// Wraps an environment.
    pub fn new(inner: E, options: ResetOptions) -> Self {
        Self { inner, options }
    }
}

impl<E: Environment> Environment for WithResetOptions<E> {
    fn spec(&self) -> &EnvironmentSpec {
        self.inner.spec()
    }

    fn reset(&mut self, seed: Option<u64>, options: &ResetOptions, observation: &mut [f32]) -> Result<Info> {
        let mut all = self.options.clone();
        all.extend(options.iter().map(|(name, value)| (name.clone(), value.clone())));
        self.inner.reset(seed, &all, observation)
    }

    fn step(&mut self, action: &[f32], observation: &mut [f32]) -> Result<Step> {
        self.inner.step(action, observation)
    }

    fn save_state(&self, snapshot: &mut Snapshot) -> Result<()> {
        self.inner.save_state(snapshot)
    }

    fn load_state(&mut self, state: &mut StateReader<'_>) -> Result<()> {
        self.inner.load_state(state)
    }

    fn render(&mut self) -> Result<Option<Image>> {
        self.inner.render()
    }
}
