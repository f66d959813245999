//! The samples of an evaluation that people look at: those answered worst, and some evenly over the data set.

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
pub struct AnsweredSample {
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

/// Keeps `most` samples of either kind.
pub struct Shown {
    most: usize,
    samples: usize,
    worst: Vec<AnsweredSample>,
    evenly: Vec<AnsweredSample>,
}

impl Shown {
    /// Of a data set of so many `samples`.
    pub fn new(most: usize, samples: usize) -> Self {
        Self { most, samples, worst: Vec::new(), evenly: Vec::new() }
    }

    /// Takes a sample, and keeps a copy where it belongs to the worst or to those that lie evenly.
    pub fn add(&mut self, answered: &AnsweredSample) {
        let order = |other: &AnsweredSample| {
            other.score.total_cmp(&answered.score).then(other.index.cmp(&answered.index))
        };
        let at = self.worst.partition_point(|other| order(other) == Ordering::Less);
        if at < self.most {
            self.worst.insert(at, answered.clone());
            self.worst.truncate(self.most);
        }
        let share = |index: usize| index * self.most.min(self.samples) / self.samples.max(1);
        if share(answered.index) < share(answered.index + 1) {
            self.evenly.push(answered.clone());
        }
    }

    /// The worst, worst first, and those that lie evenly.
    pub fn into_samples(self) -> (Vec<AnsweredSample>, Vec<AnsweredSample>) {
        (self.worst, self.evenly)
    }
}

/// Samples, each as it should be and as it was answered; `None` when they have no pictures. Answers of a confidence below
/// `least` are not drawn.
pub fn sheet(samples: &[AnsweredSample], dataset: &dyn DatasetIterator, least: f32) -> Result<Option<Image>> {
    let mut pictures = Vec::new();
    for AnsweredSample { index, name, score, prediction } in samples {
        let sample = dataset.get(*index)?;
        let answer = Sample { target: Some(confident(prediction, least)), ..sample.clone() };
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

/// What of an answer has at least this confidence.
fn confident(answer: &Value, least: f32) -> Value {
    let mut answer = answer.clone();
    match &mut answer {
        Value::BoundingBoxList(list) => list.boxes.retain(|found| found.confidence >= least),
        Value::BoundingBox3DList(list) => list.boxes.retain(|found| found.confidence >= least),
        Value::PoseList(list) => list.poses.retain(|pose| pose.confidence >= least),
        _ => {}
    }
    answer
}

#[cfg(test)]
mod tests {
    use opendr_engine::target::{BoundingBox, BoundingBoxList, Category};

    use super::*;

    fn shown(most: usize, scores: &[f64]) -> (Vec<usize>, Vec<usize>) {
        let mut shown = Shown::new(most, scores.len());
        for (index, &score) in scores.iter().enumerate() {
            let prediction = Category::default().into();
            shown.add(&AnsweredSample { index, name: index.to_string(), score, prediction });
        }
        let indices = |samples: Vec<AnsweredSample>| samples.iter().map(|sample| sample.index).collect();
        let (worst, evenly) = shown.into_samples();
        (indices(worst), indices(evenly))
    }

    #[test]
    fn the_worst_come_first() {
        assert_eq!(shown(2, &[0.5, 1.0, 0.25, 0.5]).0, [2, 0]);
    }

    #[test]
    fn some_lie_evenly() {
        assert_eq!(shown(3, &[1.0; 7]).1, [2, 4, 6]);
        assert_eq!(shown(3, &[1.0; 2]).1, [0, 1]);
    }

    #[test]
    fn what_nobody_would_see_is_not_drawn() {
        let boxes = [0.2, 0.6].map(|confidence| BoundingBox { confidence, ..BoundingBox::default() });
        let answer = BoundingBoxList::from(boxes.to_vec()).into();
        let Value::BoundingBoxList(left) = confident(&answer, 0.5) else { panic!("another type") };
        assert_eq!(left.boxes.len(), 1);
    }
}
