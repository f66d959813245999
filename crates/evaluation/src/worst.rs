//! The samples that a learner answered worst.

use std::cmp::Ordering;

use opendr_engine::Value;
use serde::Serialize;

/// A sample and how good its answer was.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct WorstSample {
    /// Its number in the data set.
    pub index: usize,
    /// What the data set calls it.
    pub name: String,
    /// 0 (worst) to 1.
    pub score: f64,
    /// What the learner answered, in the classes of the data set.
    #[serde(skip)]
    pub prediction: Value,
}

/// Keeps the worst.
pub struct Worst {
    most: usize,
    samples: Vec<WorstSample>,
}

impl Worst {
    pub fn new(most: usize) -> Self {
        Self { most, samples: Vec::new() }
    }

    pub fn add(&mut self, index: usize, score: f64, name: impl FnOnce() -> String, prediction: Value) {
        let order = |other: &WorstSample| match other.score.total_cmp(&score) {
            Ordering::Equal => other.index.cmp(&index),
            order => order,
        };
        let at = self.samples.partition_point(|other| order(other) == Ordering::Less);
        if at < self.most {
            self.samples.insert(at, WorstSample { index, name: name(), score, prediction });
            self.samples.truncate(self.most);
        }
    }

    pub fn into_samples(self) -> Vec<WorstSample> {
        self.samples
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use opendr_engine::target::Category;

    #[test]
    fn the_worst_come_first() {
        let mut worst = Worst::new(2);
        for (index, score) in [0.5, 1.0, 0.25, 0.5].into_iter().enumerate() {
            worst.add(index, score, || index.to_string(), Category::default().into());
        }
        let indices: Vec<_> = worst.into_samples().iter().map(|sample| sample.index).collect();
        assert_eq!(indices, [2, 0]);
    }
}
