//! Normalisation of observations to mean 0 and variance 1.

use opendr_engine::data::Image;
use opendr_engine::environment::{
    Environment, EnvironmentSpec, Info, ResetOptions, Snapshot, Space, StateReader, Step,
};
use opendr_engine::{Error, Result};

use super::RunningMoments;

/// Normalises observations by their running mean and variance (Gymnasium's `NormalizeObservation`).
#[derive(Debug, Clone)]
pub struct NormaliseObservation<E> {
    inner: E,
    spec: EnvironmentSpec,
    /// Running statistics of the observations; save them with a policy.
    pub moments: RunningMoments,
    /// Whether observations update the statistics; disable it for evaluations.
    pub update_statistics: bool,
}

impl<E: Environment> NormaliseObservation<E> {
    /// Wraps an environment, with no observations counted.
    ///
    /// # Errors
    /// `Unsupported` when the observation space is not a box.
    pub fn new(inner: E) -> Result<Self> {
        let mut spec = inner.spec().clone();
        let Space::Box { shape, .. } = &spec.observation else {
            let space = &spec.observation;
            return Err(Error::unsupported(format!(
                "the observation space {space} cannot be normalised; flatten it to a box first"
            )));
        };
        spec.observation = Space::uniform(f32::NEG_INFINITY, f32::INFINITY, shape)?;
        Ok(Self {
            inner,
            moments: RunningMoments::new(spec.observation.len()),
            spec,
            update_statistics: true,
        })
    }

    fn normalise(&mut self, observation: &mut [f32]) {
        if self.update_statistics {
            self.moments.add(observation.iter().copied().map(f64::from));
        }
        self.moments.normalise(observation);
    }
}

impl<E: Environment> Environment for NormaliseObservation<E> {
    fn spec(&self) -> &EnvironmentSpec {
        &self.spec
    }

    fn reset(&mut self, seed: Option<u64>, options: &ResetOptions, observation: &mut [f32]) -> Result<Info> {
        let info = self.inner.reset(seed, options, observation)?;
        self.normalise(observation);
        Ok(info)
    }

    fn step(&mut self, action: &[f32], observation: &mut [f32]) -> Result<Step> {
        let step = self.inner.step(action, observation)?;
        self.normalise(observation);
        Ok(step)
    }

    fn save_state(&self, snapshot: &mut Snapshot) -> Result<()> {
        self.moments.save(snapshot);
        self.inner.save_state(snapshot)
    }

    fn load_state(&mut self, state: &mut StateReader<'_>) -> Result<()> {
        self.moments.load(state)?;
        self.inner.load_state(state)
    }

    fn render(&mut self) -> Result<Option<Image>> {
        self.inner.render()
    }
}
