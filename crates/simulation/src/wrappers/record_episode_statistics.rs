//! Returns and lengths of episodes.

use std::collections::VecDeque;

use opendr_engine::Result;
use opendr_engine::data::Image;
use opendr_engine::environment::{
    Environment, EnvironmentSpec, Info, ResetOptions, Snapshot, StateReader, Step,
};

/// Sets `episode_return` and `episode_length` in the info of the last step of an episode, and keeps those of the last
/// 100 episodes (Gymnasium's `RecordEpisodeStatistics`).
#[derive(Debug, Clone)]
pub struct RecordEpisodeStatistics<E> {
    inner: E,
    total_reward: f64,
    length: u64,
    last: VecDeque<(f64, u64)>,
}

/// Number of episodes that are kept.
const MAX_EPISODES: usize = 100;

impl<E: Environment> RecordEpisodeStatistics<E> {
    /// Wraps an environment.
    pub fn new(inner: E) -> Self {
        Self { inner, total_reward: 0.0, length: 0, last: VecDeque::with_capacity(MAX_EPISODES) }
    }

    /// Returns return and length of the last 100 episodes, oldest first.
    pub fn last_episodes(&self) -> impl ExactSizeIterator<Item = (f64, u64)> + '_ {
        self.last.iter().copied()
    }
}

impl<E: Environment> Environment for RecordEpisodeStatistics<E> {
    fn spec(&self) -> &EnvironmentSpec {
        self.inner.spec()
    }

    fn reset(&mut self, seed: Option<u64>, options: &ResetOptions, observation: &mut [f32]) -> Result<Info> {
        (self.total_reward, self.length) = (0.0, 0);
        self.inner.reset(seed, options, observation)
    }

    fn step(&mut self, action: &[f32], observation: &mut [f32]) -> Result<Step> {
        let mut step = self.inner.step(action, observation)?;
        self.total_reward += step.reward;
        self.length += 1;
        if step.is_over() {
            step.info.set("episode_return", self.total_reward);
            step.info.set("episode_length", self.length as f64);
            if self.last.len() == MAX_EPISODES {
                self.last.pop_front();
            }
            self.last.push_back((self.total_reward, self.length));
        }
        Ok(step)
    }

    fn save_state(&self, snapshot: &mut Snapshot) -> Result<()> {
        snapshot.push_number(self.total_reward);
        snapshot.push(self.length);
        snapshot.push(self.last.len() as u64);
        for (total_reward, length) in &self.last {
            snapshot.push_number(*total_reward);
            snapshot.push(*length);
        }
        self.inner.save_state(snapshot)
    }

    fn load_state(&mut self, state: &mut StateReader<'_>) -> Result<()> {
        (self.total_reward, self.length) = (state.finite()?, state.word()?);
        self.last.clear();
        for _ in 0..state.count(MAX_EPISODES)? {
            self.last.push_back((state.finite()?, state.word()?));
        }
        self.inner.load_state(state)
    }

    fn render(&mut self) -> Result<Option<Image>> {
        self.inner.render()
    }
}
