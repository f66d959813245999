//! Returns and lengths of episodes.

use std::collections::VecDeque;

use opendr_engine::Result;
use opendr_engine::data::Image;
use opendr_engine::environment::{
    Environment, EnvironmentSpec, Info, ResetOptions, Snapshot, StateReader, Step,
};

/// Sets `episode_return` and `episode_length` in the info of the step that ends an episode, and keeps those of the last
/// hundred (Gymnasium's `RecordEpisodeStatistics`).
#[derive(Debug, Clone)]
pub struct RecordEpisodeStatistics<E> {
    inner: E,
    earned: f64,
    length: u64,
    last: VecDeque<(f64, u64)>,
}

/// Episodes that are kept.
const KEPT: usize = 100;

impl<E: Environment> RecordEpisodeStatistics<E> {
    /// Records what `inner` earns.
    pub fn new(inner: E) -> Self {
        Self { inner, earned: 0.0, length: 0, last: VecDeque::with_capacity(KEPT) }
    }

    /// Return and length of the last hundred episodes, oldest first.
    pub fn last_episodes(&self) -> impl ExactSizeIterator<Item = (f64, u64)> + '_ {
        self.last.iter().copied()
    }
}

impl<E: Environment> Environment for RecordEpisodeStatistics<E> {
    fn spec(&self) -> &EnvironmentSpec {
        self.inner.spec()
    }

    fn reset(&mut self, seed: Option<u64>, options: &ResetOptions, observation: &mut [f32]) -> Result<Info> {
        (self.earned, self.length) = (0.0, 0);
        self.inner.reset(seed, options, observation)
    }

    fn step(&mut self, action: &[f32], observation: &mut [f32]) -> Result<Step> {
        let mut step = self.inner.step(action, observation)?;
        self.earned += step.reward;
        self.length += 1;
        if step.is_over() {
            step.info.set("episode_return", self.earned);
            step.info.set("episode_length", self.length as f64);
            if self.last.len() == KEPT {
                self.last.pop_front();
            }
            self.last.push_back((self.earned, self.length));
        }
        Ok(step)
    }

    fn save_state(&self, snapshot: &mut Snapshot) -> Result<()> {
        snapshot.push_number(self.earned);
        snapshot.push(self.length);
        snapshot.push(self.last.len() as u64);
        for (earned, length) in &self.last {
            snapshot.push_number(*earned);
            snapshot.push(*length);
        }
        self.inner.save_state(snapshot)
    }

    fn load_state(&mut self, state: &mut StateReader<'_>) -> Result<()> {
        (self.earned, self.length) = (state.finite()?, state.word()?);
        self.last.clear();
        for _ in 0..state.count(KEPT)? {
            self.last.push_back((state.finite()?, state.word()?));
        }
        self.inner.load_state(state)
    }

    fn render(&mut self) -> Result<Option<Image>> {
        self.inner.render()
    }
}
