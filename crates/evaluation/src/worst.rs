//! The samples that a learner answered worst.

use std::cmp::Ordering;

use opendr_datasets::picture_with_target;
use opendr_engine::data::Image;
use opendr_engine::dataset::{DatasetIterator, Sample};
use opendr_engine::{Result, Value};
use opendr_vision::draw;
use serde::Serialize;

/// Pictures in a row: pairs of truth and answer.
const COLUMNS: usize = 6;
/// Side of a picture, pixels.
const SIDE: usize = 300;

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

/// The worst samples, each as it should be and as it was answered; `None` when they have no pictures.
pub fn worst_sheet(worst: &[WorstSample], dataset: &dyn DatasetIterator) -> Result<Option<Image>> {
    let mut pictures = Vec::new();
    for WorstSample { index, name, score, prediction } in worst {
        let sample = dataset.get(*index)?;
        let answer = Sample { target: Some(prediction.clone()), ..sample.clone() };
        if let (Some(truth), Some(answer)) = (picture_with_target(&sample), picture_with_target(&answer)) {
            pictures.push((truth, name.clone()));
            pictures.push((answer, format!("answered, {score:.2}")));
        }
    }
    if pictures.is_empty() {
        return Ok(None);
    }
    draw::contact_sheet(&pictures, COLUMNS, SIDE).map(Some)
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
