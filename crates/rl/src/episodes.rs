//! Returns and lengths of the episodes of a training.

use std::collections::VecDeque;

use opendr_engine::Result;
use opendr_engine::environment::{Snapshot, StateReader};
use opendr_simulation::vector::Batch;

/// Number of episodes over which means are computed.
const KEPT: usize = 100;

/// Statistics of a finished episode.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Episode {
    /// Return: the sum of its rewards.
    pub total_reward: f64,
    /// Number of steps.
    pub length: u64,
    /// Value of `success` in its final info, if present.
    pub success: Option<bool>,
}

/// Statistics of the running episodes and of the last 100 finished ones.
#[derive(Debug, Clone)]
pub struct Episodes {
    running: Vec<(f64, u64)>,
    last: VecDeque<Episode>,
    count: u64,
}

impl Episodes {
    pub(crate) fn new(environments: usize) -> Self {
        Self { running: vec![(0.0, 0); environments], last: VecDeque::with_capacity(KEPT), count: 0 }
    }

    /// Adds a step of all environments.
    pub(crate) fn add(&mut self, batch: &Batch) {
        for (index, (earned, length)) in self.running.iter_mut().enumerate() {
            *earned += batch.rewards[index];
            *length += 1;
            if batch.terminated[index] || batch.truncated[index] {
                let success = batch.final_infos[index].success();
                if self.last.len() == KEPT {
                    self.last.pop_front();
                }
                self.last.push_back(Episode { total_reward: *earned, length: *length, success });
                (*earned, *length) = (0.0, 0);
                self.count += 1;
            }
        }
    }

    /// Discards the running episodes.
    pub(crate) fn discard_running(&mut self) {
        self.running.fill((0.0, 0));
    }

    /// Returns the number of finished episodes.
    pub fn count(&self) -> u64 {
        self.count
    }

    /// Returns the last 100 episodes, oldest first.
    pub fn last(&self) -> impl ExactSizeIterator<Item = &Episode> {
        self.last.iter()
    }

    /// Returns the mean return of the last 100 episodes; none before the first has ended.
    pub fn mean_return(&self) -> Option<f64> {
        self.mean(|episode| Some(episode.total_reward))
    }

    /// Returns the mean length of the last 100 episodes, in steps.
    pub fn mean_length(&self) -> Option<f64> {
        self.mean(|episode| Some(episode.length as f64))
    }

    /// Returns the success rate over the episodes that report `success`.
    pub fn success_rate(&self) -> Option<f64> {
        self.mean(|episode| episode.success.map(f64::from))
    }

    fn mean(&self, of: impl Fn(&Episode) -> Option<f64>) -> Option<f64> {
        let reported = self.last.iter().filter_map(of);
        let (sum, count) = reported.fold((0.0, 0), |(sum, count), number| (sum + number, count + 1));
        (count > 0).then(|| sum / f64::from(count))
    }

    pub(crate) fn save(&self, words: &mut Snapshot) {
        words.push(self.count);
        for (earned, length) in &self.running {
            words.push_number(*earned);
            words.push(*length);
        }
        words.push(self.last.len() as u64);
        for episode in &self.last {
            words.push_number(episode.total_reward);
            words.push(episode.length);
            words.push(episode.success.map_or(2, u64::from));
        }
    }

    pub(crate) fn load(&mut self, words: &mut StateReader<'_>) -> Result<()> {
        self.count = words.word()?;
        for (earned, length) in &mut self.running {
            (*earned, *length) = (words.finite()?, words.word()?);
        }
        self.last.clear();
        for _ in 0..words.count(KEPT)? {
            let (earned, length) = (words.finite()?, words.word()?);
            let success = match words.count(2)? {
                2 => None,
                reported => Some(reported == 1),
            };
            self.last.push_back(Episode { total_reward: earned, length, success });
        }
        Ok(())
    }
}
