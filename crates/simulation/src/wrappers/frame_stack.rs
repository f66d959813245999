//! Stacking of the last observations.

use opendr_engine::data::Image;
use opendr_engine::environment::{
    Environment, EnvironmentSpec, Info, ResetOptions, Snapshot, Space, StateReader, Step,
};
use opendr_engine::{Error, Result};

/// Stacks the last observations, oldest first, along a new first axis (Gymnasium's `FrameStackObservation`). At the
/// start of an episode its first observation is repeated.
#[derive(Debug, Clone)]
pub struct FrameStack<E> {
    inner: E,
    spec: EnvironmentSpec,
    frames: Vec<f32>,
}

impl<E: Environment> FrameStack<E> {
    /// Stacks `count` observations.
    ///
    /// # Errors
    /// `InvalidParam` when `count` is 0 or too large, `Unsupported` when the observation space is not a box.
    pub fn new(inner: E, count: usize) -> Result<Self> {
        let mut spec = inner.spec().clone();
        let Space::Box { low, high, shape, dtype } = &spec.observation else {
            let space = &spec.observation;
            return Err(Error::unsupported(format!(
                "the observation space {space} cannot be stacked; flatten it to a box first"
            )));
        };
        if count == 0 || low.len().checked_mul(count).is_none_or(|numbers| numbers > 1 << 28) {
            return Err(Error::invalid_param(format!(
                "{count} frames of {} numbers; give at least 1 frame and at most 2^28 numbers",
                low.len()
            )));
        }
        let shape = [&[count], &shape[..]].concat();
        let (low, high) = (low.repeat(count), high.repeat(count));
        spec.observation = Space::Box { low, high, shape, dtype: *dtype };
        Ok(Self { inner, frames: vec![0.0; spec.observation.len()], spec })
    }

    fn write_stack(&self, observation: &mut [f32]) -> Result<()> {
        if observation.len() != self.frames.len() {
            let (expected, count) = (self.frames.len(), observation.len());
            return Err(Error::invalid_input(format!(
                "stacked observations of {} have {expected} numbers, not {count}",
                self.spec.id
            )));
        }
        observation.copy_from_slice(&self.frames);
        Ok(())
    }

    fn size(&self) -> usize {
        self.inner.spec().observation.len()
    }
}

impl<E: Environment> Environment for FrameStack<E> {
    fn spec(&self) -> &EnvironmentSpec {
        &self.spec
    }

    fn reset(&mut self, seed: Option<u64>, options: &ResetOptions, observation: &mut [f32]) -> Result<Info> {
        let size = self.size();
        let info = self.inner.reset(seed, options, &mut self.frames[..size])?;
        for begin in (size..self.frames.len()).step_by(size.max(1)) {
            self.frames.copy_within(..size, begin);
        }
        self.write_stack(observation)?;
        Ok(info)
    }

    fn step(&mut self, action: &[f32], observation: &mut [f32]) -> Result<Step> {
        let size = self.size();
        // The inner environment writes the newest over the oldest; the rotation then moves it to the end.
        let step = self.inner.step(action, &mut self.frames[..size])?;
        self.frames.rotate_left(size);
        self.write_stack(observation)?;
        Ok(step)
    }

    fn save_state(&self, snapshot: &mut Snapshot) -> Result<()> {
        snapshot.extend_numbers(self.frames.iter().copied().map(f64::from));
        self.inner.save_state(snapshot)
    }

    fn load_state(&mut self, state: &mut StateReader<'_>) -> Result<()> {
        for number in &mut self.frames {
            *number = state.number()? as f32;
        }
        self.inner.load_state(state)
    }

    fn render(&mut self) -> Result<Option<Image>> {
        self.inner.render()
    }
}
