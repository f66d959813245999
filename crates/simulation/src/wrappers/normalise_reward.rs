//! Normalisation of rewards.

use opendr_engine::data::Image;
use opendr_engine::environment::{
    Environment, EnvironmentSpec, Info, ResetOptions, Snapshot, StateReader, Step,
};
use opendr_engine::{Error, Result};

use super::RunningMoments;
use super::running_moments::EPSILON;

/// Divides rewards by the standard deviation of the discounted return (Gymnasium's `NormalizeReward`).
#[derive(Debug, Clone)]
pub struct NormaliseReward<E> {
    inner: E,
    spec: EnvironmentSpec,
    discount: f64,
    discounted: f64,
    /// Running statistics of the discounted return; save them with a policy.
    pub moments: RunningMoments,
    /// Whether rewards update the statistics.
    pub update_statistics: bool,
}

impl<E: Environment> NormaliseReward<E> {
    /// Wraps an environment; `discount` is usually 0.99.
    ///
    /// # Errors
    /// `InvalidParam` when it is not in [0, 1].
    pub fn new(inner: E, discount: f64) -> Result<Self> {
        if !(0.0..=1.0).contains(&discount) {
            return Err(Error::invalid_param(format!("the discount is {discount}; give a number in [0, 1]")));
        }
        let spec = EnvironmentSpec {
            reward_range: (f64::NEG_INFINITY, f64::INFINITY),
            reward_threshold: None,
            ..inner.spec().clone()
        };
        Ok(Self {
            inner,
            spec,
            discount,
            discounted: 0.0,
            moments: RunningMoments::new(1),
            update_statistics: true,
        })
    }
}

impl<E: Environment> Environment for NormaliseReward<E> {
    fn spec(&self) -> &EnvironmentSpec {
        &self.spec
    }

    fn reset(&mut self, seed: Option<u64>, options: &ResetOptions, observation: &mut [f32]) -> Result<Info> {
        self.inner.reset(seed, options, observation)
    }

    fn step(&mut self, action: &[f32], observation: &mut [f32]) -> Result<Step> {
        let mut step = self.inner.step(action, observation)?;
        // As in Gymnasium, the return continues after a truncated episode.
        let carried = if step.terminated { 0.0 } else { self.discounted * self.discount };
        self.discounted = carried + step.reward;
        if self.update_statistics {
            self.moments.add([self.discounted]);
        }
        step.reward /= (self.moments.variance()[0] + EPSILON).sqrt();
        Ok(step)
    }

    fn save_state(&self, snapshot: &mut Snapshot) -> Result<()> {
        snapshot.push_number(self.discounted);
        self.moments.save(snapshot);
        self.inner.save_state(snapshot)
    }

    fn load_state(&mut self, state: &mut StateReader<'_>) -> Result<()> {
        self.discounted = state.finite()?;
        self.moments.load(state)?;
        self.inner.load_state(state)
    }

    fn render(&mut self) -> Result<Option<Image>> {
        self.inner.render()
    }
}
