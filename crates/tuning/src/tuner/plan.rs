//! How long trainings last, and where they are measured.

use opendr_engine::{Error, Result};

use crate::study::{fresh_seeds, training_seeds};

/// How long trainings last, where they are measured, and with which seeds.
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    pub(super) points: Vec<u64>,
    pub(super) seeds: Vec<u64>,
    pub(super) fresh_seeds: Vec<u64>,
}

/// Of 100,000 measurements of every trial nothing would be left to train in.
const MOST_POINTS: u64 = 100_000;

impl Plan {
    /// Trainings of `length` units, measured after every `interval`, with three seeds, and three others for the best. The
    /// rungs of a pruner should be multiples of the interval.
    ///
    /// # Errors
    /// `InvalidParam` when the interval is 0 or more than the length, or there are more than 100,000 of them.
    pub fn every(interval: u64, length: u64) -> Result<Self> {
        if interval == 0 || interval > length || length / interval > MOST_POINTS {
            return Err(Error::invalid_param(format!(
                "trainings of {length} measured after every {interval}: give an interval from 1 to the length, of which \
                 there are at most {MOST_POINTS}"
            )));
        }
        let points = (1..=length.div_ceil(interval)).map(|at| (at * interval).min(length)).collect();
        Self::at(points)
    }

    /// The same measured after `points` units; the last is the length.
    ///
    /// # Errors
    /// `InvalidParam` when there are none, or they do not grow.
    pub fn at(points: Vec<u64>) -> Result<Self> {
        let grow = points.first() > Some(&0) && points.windows(2).all(|pair| pair[0] < pair[1]);
        if !grow || points.last() > Some(&(i64::MAX as u64 / 1000)) {
            return Err(Error::invalid_param(format!(
                "measurements after {points:?}: give numbers above 0 that grow; the last is the length of a training"
            )));
        }
        Ok(Self { points, seeds: Vec::new(), fresh_seeds: Vec::new() }.with_seeds(0, 3))
    }

    /// With `count` seeds for every configuration, and as many others for the best of them; all follow from `seed`.
    #[must_use]
    pub fn with_seeds(self, seed: u64, count: usize) -> Self {
        let count = count.max(1);
        Self { seeds: training_seeds(seed, count), fresh_seeds: fresh_seeds(seed, count), ..self }
    }

    /// The units of a whole training.
    pub fn length(&self) -> u64 {
        self.points.last().copied().unwrap_or(0)
    }

    /// The seeds that every configuration is trained with.
    pub fn seeds(&self) -> &[u64] {
        &self.seeds
    }
}
