//! Accumulation of lists of boxes, by class.

use opendr_engine::Result;
use opendr_engine::target::{BoundingBox, BoundingBoxList, Classes};

use super::accumulator::Accumulator;
use super::matching::{Detection, GroundTruth};
use crate::class_key::ClassKey;

/// An accumulator of lists of boxes, with or without masks.
#[derive(Debug, Clone)]
pub(super) struct ListAccumulator {
    pub accumulator: Accumulator<ClassKey>,
    /// Class names of the data set.
    pub classes: Classes,
    pub use_classes: bool,
}

impl ListAccumulator {
    /// Adds an image and returns the quality of its detections, 0 to 1. `overlap(detection, ground truth, crowd)` compares elements
    /// of `detected` and `annotated`.
    pub(super) fn add<S>(
        &mut self,
        at: u32,
        [prediction, ground_truth]: [&BoundingBoxList; 2],
        [detected, annotated]: [&[S]; 2],
        detections: &[Detection],
        ground_truths: &[GroundTruth],
        overlap: impl Fn(&S, &S, bool) -> Result<f64>,
    ) -> Result<f64> {
        if self.classes.is_empty() {
            self.classes = ground_truth.classes.clone();
        }
        let keys = |list: &BoundingBoxList| {
            let key =
                |object: &BoundingBox| ClassKey::new(&object.name, &list.classes, &ground_truth.classes);
            list.boxes.iter().map(key).collect::<Vec<_>>()
        };
        let (detected_keys, annotated_keys) = (sorted(keys(prediction)), sorted(keys(ground_truth)));
        let mut classes: Vec<Option<&ClassKey>> = vec![None];
        if self.use_classes {
            classes = detected_keys.iter().chain(&annotated_keys).map(|(key, _)| Some(key)).collect();
            classes.sort_unstable();
            classes.dedup();
        }
        let mut qualities = Vec::new();
        for class in classes {
            let of_class = |all: &[(ClassKey, usize)]| -> Vec<usize> {
                all.iter()
                    .filter(|(key, _)| class.is_none_or(|class| class == key))
                    .map(|(_, at)| *at)
                    .collect()
            };
            let (detected_indices, annotated_indices) = (of_class(&detected_keys), of_class(&annotated_keys));
            let some = |indices: &[usize]| indices.iter().map(|at| detections[*at]).collect::<Vec<_>>();
            let ground_truths: Vec<_> = annotated_indices.iter().map(|at| ground_truths[*at]).collect();
            let quality = self.accumulator.add(
                class.unwrap_or(&ClassKey::Any),
                at,
                &ground_truths,
                &some(&detected_indices),
                |detection, ground_truth| {
                    overlap(
                        &detected[detected_indices[detection]],
                        &annotated[annotated_indices[ground_truth]],
                        ground_truths[ground_truth].crowd,
                    )
                },
            )?;
            qualities.extend(quality);
        }
        Ok(match qualities.len() {
            0 => quality_without_objects(detections),
            count => qualities.iter().sum::<f64>() / count as f64,
        })
    }

    pub(super) fn merge(&mut self, other: Self) {
        if self.classes.is_empty() {
            self.classes = other.classes;
        }
        self.accumulator.merge(other.accumulator);
    }
}

/// Returns the quality of detections in an image without objects.
pub(super) fn quality_without_objects(detections: &[Detection]) -> f64 {
    let highest = detections.iter().map(|detection| detection.score).fold(0.0, f64::max);
    1.0 - highest.min(1.0)
}

/// Returns class and index of the boxes, sorted by class.
fn sorted(keys: Vec<ClassKey>) -> Vec<(ClassKey, usize)> {
    let mut keys: Vec<_> = keys.into_iter().enumerate().map(|(at, key)| (key, at)).collect();
    keys.sort();
    keys
}
