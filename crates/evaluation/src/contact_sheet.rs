//! Selection of samples for contact sheets: those with the lowest scores, and some spaced evenly over the data set.

use std::cmp::Ordering;

use opendr_datasets::draw_sample;
use opendr_engine::data::Image;
use opendr_engine::dataset::{DatasetIterator, Sample};
use opendr_engine::{Result, Value};
use opendr_vision::draw;
use serde::{Deserialize, Serialize};

/// Images per row: pairs of ground truth and prediction.
const COLUMNS: usize = 6;
/// Side of an image, in pixels.
const SIDE: usize = 300;

/// A sample with its prediction and score.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ScoredSample {
    /// Index in the data set.
    pub index: usize,
    /// Name in the data set.
    pub name: String,
    /// Score of the prediction, 0 to 1, the best.
    pub score: f64,
    /// Prediction, in the classes of the data set; `None` in a report that was read from a file.
    #[serde(skip)]
    pub prediction: Option<Value>,
}

/// Collects at most `limit` samples of each kind.
pub struct ContactSheetSamples {
    limit: usize,
    samples: usize,
    lowest: Vec<ScoredSample>,
    evenly_spaced: Vec<ScoredSample>,
}

impl ContactSheetSamples {
    /// Creates a collector for a data set of `samples` samples.
    pub fn new(limit: usize, samples: usize) -> Self {
        Self { limit, samples, lowest: Vec::new(), evenly_spaced: Vec::new() }
    }

    /// Adds a sample; keeps a copy if it is among the lowest scores or evenly spaced.
    pub fn add(&mut self, sample: &ScoredSample) {
        let order =
            |other: &ScoredSample| other.score.total_cmp(&sample.score).then(other.index.cmp(&sample.index));
        let at = self.lowest.partition_point(|other| order(other) == Ordering::Less);
        if at < self.limit {
            self.lowest.insert(at, sample.clone());
            self.lowest.truncate(self.limit);
        }
        let share = |index: usize| index * self.limit.min(self.samples) / self.samples.max(1);
        if share(sample.index) < share(sample.index + 1) {
            self.evenly_spaced.push(sample.clone());
        }
    }

    /// Returns the samples with the lowest scores, lowest first, and the evenly spaced ones.
    pub fn into_samples(self) -> (Vec<ScoredSample>, Vec<ScoredSample>) {
        (self.lowest, self.evenly_spaced)
    }
}

/// Draws a contact sheet of samples, each with its ground truth and its prediction; `None` when they have no images. Predictions
/// with a confidence below `least` are not drawn.
pub fn contact_sheet(
    samples: &[ScoredSample],
    dataset: &dyn DatasetIterator,
    least: f32,
) -> Result<Option<Image>> {
    let mut images = Vec::new();
    for ScoredSample { index, name, score, prediction } in samples {
        let sample = dataset.get(*index)?;
        let target = prediction.as_ref().map(|prediction| confident(prediction, least));
        let predicted = Sample { target, ..sample.clone() };
        if let (Some(ground_truth), Some(predicted)) = (draw_sample(&sample), draw_sample(&predicted)) {
            images.push((ground_truth, name.clone()));
            images.push((predicted, format!("predicted, {score:.2}")));
        }
    }
    if images.is_empty() {
        return Ok(None);
    }
    draw::contact_sheet(&images, COLUMNS, SIDE).map(Some)
}

/// Returns a prediction without the objects below a confidence.
fn confident(prediction: &Value, least: f32) -> Value {
    let mut prediction = prediction.clone();
    match &mut prediction {
        Value::BoundingBoxList(list) => list.boxes.retain(|found| found.confidence >= least),
        Value::BoundingBox3DList(list) => list.boxes.retain(|found| found.confidence >= least),
        Value::PoseList(list) => list.poses.retain(|pose| pose.confidence >= least),
        _ => {}
    }
    prediction
}

#[cfg(test)]
mod tests {
    use opendr_engine::target::{BoundingBox, BoundingBoxList, Category};

    use super::*;

    fn selected(limit: usize, scores: &[f64]) -> (Vec<usize>, Vec<usize>) {
        let mut selected = ContactSheetSamples::new(limit, scores.len());
        for (index, &score) in scores.iter().enumerate() {
            let prediction = Some(Category::default().into());
            selected.add(&ScoredSample { index, name: index.to_string(), score, prediction });
        }
        let indices = |samples: Vec<ScoredSample>| samples.iter().map(|sample| sample.index).collect();
        let (lowest, evenly_spaced) = selected.into_samples();
        (indices(lowest), indices(evenly_spaced))
    }

    #[test]
    fn the_lowest_scores_come_first() {
        assert_eq!(selected(2, &[0.5, 1.0, 0.25, 0.5]).0, [2, 0]);
    }

    #[test]
    fn some_are_evenly_spaced() {
        assert_eq!(selected(3, &[1.0; 7]).1, [2, 4, 6]);
        assert_eq!(selected(3, &[1.0; 2]).1, [0, 1]);
    }

    #[test]
    fn predictions_of_low_confidence_are_not_drawn() {
        let boxes = [0.2, 0.6].map(|confidence| BoundingBox { confidence, ..BoundingBox::default() });
        let prediction = BoundingBoxList::from(boxes.to_vec()).into();
        let Value::BoundingBoxList(left) = confident(&prediction, 0.5) else { panic!("another type") };
        assert_eq!(left.boxes.len(), 1);
    }
}
