//! Semantic segmentation: intersection over union and accuracies of classes from one confusion matrix.

use opendr_engine::params::Params;
use opendr_engine::target::{Classes, Heatmap, HeatmapValues};
use opendr_engine::{Error, Result};

use crate::average::{mean, ratio};
use crate::{Figure, Matrix, Metric, Report, Table};

/// Maximum number of classes, for at most 8 MiB of counts.
const MAX_CLASSES: usize = 1024;

/// Pixels per run: runs of equal pixels, as inside of objects, are counted at once.
const RUN: usize = 16;

/// Parameters of [`Segmentation`].
#[derive(Debug, Clone, Params)]
pub struct SegmentationParams {
    /// Label of ignored pixels.
    #[param(default = Some(255), range = 0..=4_294_967_295_u32)]
    pub ignore: Option<u32>,
}

/// Numbers of pixels by ground truth (row) and prediction (column).
///
/// Row and column `classes` contain an ignored label that is not a class index; an ignored class index has its own row.
#[derive(Debug, Clone, Default, PartialEq)]
struct Pixels {
    classes: usize,
    counts: Vec<u64>,
}

impl Pixels {
    fn new(classes: usize) -> Self {
        Self { classes, counts: vec![0; (classes + 1) * (classes + 1)] }
    }

    fn count(&mut self, ground_truth: &[u32], predicted: &[u32]) {
        let (runs, rest) = ground_truth.as_chunks::<RUN>();
        let (predictions, rest_of_predictions) = predicted.as_chunks::<RUN>();
        let differing = |run: &[u32; RUN]| run.iter().fold(0, |bits, label| bits | (label ^ run[0]));
        for (run, prediction) in runs.iter().zip(predictions) {
            if differing(run) | differing(prediction) == 0 {
                *self.at(run[0], prediction[0]) += RUN as u64;
            } else {
                self.count_each(run, prediction);
            }
        }
        self.count_each(rest, rest_of_predictions);
    }

    fn count_each(&mut self, ground_truth: &[u32], predicted: &[u32]) {
        for (ground_truth, predicted) in ground_truth.iter().zip(predicted) {
            *self.at(*ground_truth, *predicted) += 1;
        }
    }

    #[inline]
    fn at(&mut self, ground_truth: u32, predicted: u32) -> &mut u64 {
        let [row, column] = [ground_truth, predicted].map(|label| label.min(self.classes as u32) as usize);
        &mut self.counts[row * (self.classes + 1) + column]
    }

    fn add(&mut self, other: &Self) {
        if self.classes < other.classes {
            let mut wider = Self::new(other.classes);
            wider.add(self);
            *self = wider;
        }
        let place = |at: usize| if at == other.classes { self.classes } else { at };
        for (row, counts) in other.counts.chunks(other.classes + 1).enumerate() {
            let start = place(row) * (self.classes + 1);
            for (column, count) in counts.iter().enumerate() {
                self.counts[start + place(column)] += count;
            }
        }
    }

    fn scores(&self, ignore: Option<u32>) -> SegmentationScores {
        let side = self.classes + 1;
        let ignored = ignore.map_or(self.classes, |label| (label as usize).min(self.classes));
        let mut classes = vec![ClassPixels::default(); self.classes];
        for (row, counts) in self.counts.chunks(side).enumerate().filter(|(row, _)| *row != ignored) {
            let Some(class) = classes.get_mut(row) else { continue };
            class.ground_truth = counts.iter().sum();
            class.hits = counts[row];
            for (column, count) in counts.iter().enumerate().filter(|(column, _)| *column != ignored) {
                if let Some(class) = classes.get_mut(column) {
                    class.predicted += count;
                }
            }
        }
        SegmentationScores { classes }
    }
}

/// Numbers of pixels of one class.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct ClassPixels {
    /// Pixels of the class that are predicted as the class.
    pub hits: u64,
    /// Pixels of the class.
    pub ground_truth: u64,
    /// Pixels predicted as the class.
    pub predicted: u64,
}

impl ClassPixels {
    /// Returns the intersection over union; `None` for a class that occurs in neither map.
    pub fn iou(&self) -> Option<f64> {
        ratio(self.hits, self.ground_truth + self.predicted - self.hits)
    }

    /// Returns the fraction of its pixels that are correct; `None` for a class without pixels.
    pub fn accuracy(&self) -> Option<f64> {
        ratio(self.hits, self.ground_truth)
    }
}

/// Pixel counts by class index.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct SegmentationScores {
    /// Counts of each class.
    pub classes: Vec<ClassPixels>,
}

impl SegmentationScores {
    fn total(&self, number: fn(&ClassPixels) -> u64) -> u64 {
        self.classes.iter().map(number).sum()
    }

    /// Returns the mean intersection over union of the classes that occur as ground truth or prediction.
    pub fn mean_iou(&self) -> Option<f64> {
        mean(self.classes.iter().filter_map(ClassPixels::iou))
    }

    /// Returns the fraction of correct pixels.
    pub fn pixel_accuracy(&self) -> Option<f64> {
        ratio(self.total(|class| class.hits), self.total(|class| class.ground_truth))
    }

    /// Returns the mean accuracy of the classes that occur in the ground truth.
    pub fn mean_accuracy(&self) -> Option<f64> {
        mean(self.classes.iter().filter_map(ClassPixels::accuracy))
    }

    /// Returns the intersection over union, weighted by the fraction of pixels of the class (Long et al., 2015).
    pub fn frequency_weighted_iou(&self) -> Option<f64> {
        let total = self.total(|class| class.ground_truth);
        let part = |class: &ClassPixels| class.iou().unwrap_or(0.0) * class.ground_truth as f64;
        (total > 0).then(|| self.classes.iter().map(part).sum::<f64>() / total as f64)
    }
}

/// Accumulates pixels. Memory grows with the square of the highest class index, not with the images.
#[derive(Debug, Clone, Default)]
pub struct Segmentation {
    params: SegmentationParams,
    names: Classes,
    pixels: Pixels,
}

impl Segmentation {
    /// Adds the pixels of an image and returns its scores. Pixels with the ignored label as ground truth do not count. A
    /// prediction of the ignored label, or of [`Heatmap::NO_CLASS`], is a miss and no false positive of any class.
    ///
    /// # Errors
    /// Returns `InvalidInput` if the maps differ in size, or a label is above 1023 and not the ignored one.
    pub fn add(&mut self, ground_truth: &[u32], predicted: &[u32]) -> Result<SegmentationScores> {
        if ground_truth.len() != predicted.len() {
            let (expected, given) = (ground_truth.len(), predicted.len());
            return Err(Error::invalid_input(format!(
                "a map of {given} pixels cannot be compared with one of {expected}; give maps of the same size"
            )));
        }
        let ignore = self.params.ignore;
        // A label that is not counted is replaced by class 0, which always exists.
        let none = ignore.unwrap_or(0);
        let highest = |labels: &[u32], uncounted: u32| {
            let counted = labels.iter().filter(|label| ![none, uncounted].contains(label));
            counted.max().copied().unwrap_or(0)
        };
        let highest = highest(ground_truth, none).max(highest(predicted, Heatmap::NO_CLASS)) as usize;
        if highest >= MAX_CLASSES {
            return Err(Error::invalid_input(format!(
                "label {highest} is not a class index below {MAX_CLASSES} and not the ignored label {ignore:?}; fix the labels"
            )));
        }
        let mut image = Pixels::new(highest + 1);
        image.count(ground_truth, predicted);
        self.pixels.add(&image);
        Ok(image.scores(ignore))
    }

    /// Returns the scores over all pixels.
    pub fn scores(&self) -> SegmentationScores {
        self.pixels.scores(self.params.ignore)
    }

    fn name(&self, class: usize) -> String {
        self.names.name(class as i64).map_or_else(|| class.to_string(), |name| name.to_string())
    }

    /// Returns the confusion matrix of the classes `present`.
    fn confusion(&self, present: &[usize]) -> Matrix {
        let count = |row: usize, column: usize| self.pixels.counts[row * (self.pixels.classes + 1) + column];
        let counts = present.iter().flat_map(|row| present.iter().map(|column| count(*row, *column)));
        Matrix {
            name: "confusion".to_owned(),
            title: "Confusion matrix of pixels".to_owned(),
            counts: counts.collect(),
            labels: present.iter().map(|class| self.name(*class)).collect(),
        }
    }
}

/// A prediction may be scores `[classes, height, width]`; the class with the highest score counts.
impl Metric for Segmentation {
    const NAME: &'static str = "segmentation";
    const ABOUT: &'static str = "mean IoU, IoU of classes and pixel accuracies of label maps";
    const NUMBERS: &'static [(&'static str, &'static str)] = &[
        ("miou", "Mean intersection over union over classes."),
        ("pixel_accuracy", "Fraction of correct pixels."),
        ("mean_accuracy", "Mean over classes of the fraction of correct pixels."),
        ("frequency_weighted_iou", "Intersection over union, weighted by the pixels of the class."),
        ("pixels", "Number of pixels."),
    ];
    type Params = SegmentationParams;
    type Prediction = Heatmap;
    type GroundTruth = Heatmap;

    fn new(params: &SegmentationParams) -> Result<Self> {
        Ok(Self { params: params.clone(), ..Self::default() })
    }

    fn update(&mut self, _at: usize, prediction: &Heatmap, ground_truth: &Heatmap) -> Result<f64> {
        let HeatmapValues::Labels(expected) = ground_truth.values() else {
            return Err(Error::invalid_input(
                "the ground truth of segmentation must be a map of labels, not of scores",
            ));
        };
        let (given, shape) = prediction.class_labels()?;
        if shape != ground_truth.shape() {
            let expected = ground_truth.shape();
            return Err(Error::invalid_input(format!(
                "a map of shape {shape:?} cannot be compared with one of {expected:?}; resize the prediction to the ground truth"
            )));
        }
        let scores = self.add(expected, &given)?;
        if self.names.is_empty() {
            let names =
                if ground_truth.classes.is_empty() { &prediction.classes } else { &ground_truth.classes };
            self.names = names.clone();
        }
        Ok(scores.mean_iou().unwrap_or(1.0))
    }

    fn merge(&mut self, other: Self) {
        self.pixels.add(&other.pixels);
        if self.names.is_empty() {
            self.names = other.names;
        }
    }

    fn finish(&self) -> Report {
        let mut report = Report::new("miou");
        let scores = self.scores();
        let numbers = [
            ("pixels", Some(scores.total(|class| class.ground_truth) as f64)),
            ("miou", scores.mean_iou()),
            ("pixel_accuracy", scores.pixel_accuracy()),
            ("mean_accuracy", scores.mean_accuracy()),
            ("frequency_weighted_iou", scores.frequency_weighted_iou()),
        ];
        for (key, value) in numbers {
            report.statistics.set(key, value.unwrap_or(f64::NAN));
        }
        let present =
            scores.classes.iter().enumerate().filter(|(_, class)| class.ground_truth + class.predicted > 0);
        let row = |(at, class): (usize, &ClassPixels)| {
            (self.name(at), vec![class.iou(), class.accuracy(), Some(class.ground_truth as f64)])
        };
        report.tables.push(Table {
            name: "class".to_owned(),
            columns: ["iou", "accuracy", "pixels"].map(str::to_owned).into(),
            rows: present.clone().map(row).collect(),
        });
        let present: Vec<usize> = present.map(|(at, _)| at).collect();
        if !present.is_empty() {
            report.figures.push(Figure::Matrix(self.confusion(&present)));
        }
        report
    }
}

#[cfg(test)]
mod tests;
