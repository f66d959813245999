//! Returns and lengths of the episodes of a training.

use std::collections::VecDeque;

use opendr_engine::Result;
use opendr_engine::environment::{Snapshot, StateReader};
use opendr_simulation::vector::Batch;

/// Episodes over which means are taken.
const KEPT: usize = 100;

/// An episode that ended.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Episode {
    /// The sum of its rewards.
    pub earned: f64,
    /// How many steps it had.
    pub length: u64,
    /// Whether its last info told of a `success`, where it told.
    pub success: Option<bool>,
}

/// What episodes earned: those that run, and the last hundred.
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

    /// Takes in a step of all environments.
    pub(crate) fn add(&mut self, batch: &Batch) {
        for (index, (earned, length)) in self.running.iter_mut().enumerate() {
            *earned += batch.rewards[index];
            *length += 1;
            if batch.terminated[index] || batch.truncated[index] {
                let success = batch.final_infos[index].success();
                if self.last.len() == KEPT {
                    self.last.pop_front();
                }
                self.last.push_back(Episode { earned: *earned, length: *length, success });
                (*earned, *length) = (0.0, 0);
                self.count += 1;
            }
        }
    }

    /// Forgets the episodes that run.
    pub(crate) fn begin_anew(&mut self) {
        self.running.fill((0.0, 0));
    }

    /// How many ended.
    pub fn count(&self) -> u64 {
        self.count
    }

    /// The last hundred, oldest first.
    pub fn last(&self) -> impl ExactSizeIterator<Item = &Episode> {
        self.last.iter()
    }

    /// The mean return of the last hundred; none before one ended.
    pub fn mean_return(&self) -> Option<f64> {
        self.mean(|episode| Some(episode.earned))
    }

    /// Their mean length.
    pub fn mean_length(&self) -> Option<f64> {
        self.mean(|episode| Some(episode.length as f64))
    }

    /// The share of successes among those that told.
    pub fn success_rate(&self) -> Option<f64> {
        self.mean(|episode| episode.success.map(f64::from))
    }

    fn mean(&self, of: impl Fn(&Episode) -> Option<f64>) -> Option<f64> {
        let told = self.last.iter().filter_map(of);
        let (sum, count) = told.fold((0.0, 0), |(sum, count), number| (sum + number, count + 1));
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
            words.push_number(episode.earned);
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
                told => Some(told == 1),
            };
            self.last.push_back(Episode { earned, length, success });
        }
        Ok(())
    }
}
