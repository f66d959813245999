//! Length of trainings and points of evaluation.

use opendr_engine::{Error, Result};

use crate::study::{fresh_seeds, training_seeds};

/// Length of a training, points of evaluation, and seeds.
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    pub(super) points: Vec<u64>,
    pub(super) seeds: Vec<u64>,
    pub(super) fresh_seeds: Vec<u64>,
}

/// Maximum number of evaluations per training.
const MAX_POINTS: u64 = 100_000;

impl Plan {
    /// Creates a plan of trainings of `length` units, evaluated after every `interval`, with three seeds, and three others for the best.
    /// The rungs of a pruner should be multiples of the interval.
    ///
    /// # Errors
    /// `InvalidParam` when the interval is 0 or exceeds the length, or there are more than 100,000 of them.
    pub fn every(interval: u64, length: u64) -> Result<Self> {
        if interval == 0 || interval > length || length / interval > MAX_POINTS {
            return Err(Error::invalid_param(format!(
                "trainings of {length} units evaluated every {interval}; give an interval from 1 to the length, of which \
                 there are at most {MAX_POINTS}"
            )));
        }
        let points = (1..=length.div_ceil(interval)).map(|at| (at * interval).min(length)).collect();
        Self::at(points)
    }

    /// Creates the same with evaluations after `points` units; the last is the length.
    ///
    /// # Errors
    /// `InvalidParam` when there are none, or they do not increase.
    pub fn at(points: Vec<u64>) -> Result<Self> {
        let grow = points.first() > Some(&0) && points.windows(2).all(|pair| pair[0] < pair[1]);
        if !grow || points.last() > Some(&(i64::MAX as u64 / 1000)) {
            return Err(Error::invalid_param(format!(
                "evaluations after {points:?} units; give increasing numbers above 0, the last is the length of a training"
            )));
        }
        Ok(Self { points, seeds: Vec::new(), fresh_seeds: Vec::new() }.with_seeds(0, 3))
    }

    /// Sets `count` seeds for every configuration, and as many others for the best; all are derived from `seed`.
    #[must_use]
    pub fn with_seeds(self, seed: u64, count: usize) -> Self {
        let count = count.max(1);
        Self { seeds: training_seeds(seed, count), fresh_seeds: fresh_seeds(seed, count), ..self }
    }

    /// Returns the length of a training, in units.
    pub fn length(&self) -> u64 {
        self.points.last().copied().unwrap_or(0)
    }

    /// Returns the seeds of every configuration.
    pub fn seeds(&self) -> &[u64] {
        &self.seeds
    }
}
