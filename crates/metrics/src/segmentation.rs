//! Semantic segmentation: intersection over union and accuracies of classes from one confusion matrix.

use opendr_engine::params::Params;
use opendr_engine::target::{Classes, Heatmap, HeatmapValues};
use opendr_engine::{Error, Result};

use crate::average::{mean, ratio};
use crate::{Figure, Matrix, Metric, Report, Table};

/// Most classes, hence at most 8 MiB of counts.
const MAX_CLASSES: usize = 1024;

/// Pixels looked at together: where all are alike, as inside of things, they are counted at once.
const RUN: usize = 16;

/// What a user may set.
#[derive(Debug, Clone, Params)]
pub struct SegmentationParams {
    /// The label of pixels that do not count.
    #[param(default = Some(255), range = 0..=4_294_967_295_u32)]
    pub ignore: Option<u32>,
}

/// Counts of pixels by truth (row) and answer (column).
///
/// Row and column `classes` hold an ignored label that is no class number; an ignored one that is keeps its own.
#[derive(Debug, Clone, Default, PartialEq)]
struct Pixels {
    classes: usize,
    counts: Vec<u64>,
}

impl Pixels {
    fn new(classes: usize) -> Self {
        Self { classes, counts: vec![0; (classes + 1) * (classes + 1)] }
    }

    fn count(&mut self, truth: &[u32], predicted: &[u32]) {
        let (runs, rest) = truth.as_chunks::<RUN>();
        let (answers, rest_of_answers) = predicted.as_chunks::<RUN>();
        let differing = |run: &[u32; RUN]| run.iter().fold(0, |bits, label| bits | (label ^ run[0]));
        for (run, answer) in runs.iter().zip(answers) {
            if differing(run) | differing(answer) == 0 {
                *self.at(run[0], answer[0]) += RUN as u64;
            } else {
                self.count_each(run, answer);
            }
        }
        self.count_each(rest, rest_of_answers);
    }

    fn count_each(&mut self, truth: &[u32], predicted: &[u32]) {
        for (truth, predicted) in truth.iter().zip(predicted) {
            *self.at(*truth, *predicted) += 1;
        }
    }

    #[inline]
    fn at(&mut self, truth: u32, predicted: u32) -> &mut u64 {
        let [row, column] = [truth, predicted].map(|label| label.min(self.classes as u32) as usize);
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
            class.truth = counts.iter().sum();
            class.hits = counts[row];
            for (column, count) in counts.iter().enumerate().filter(|(column, _)| *column != ignored) {
                if let Some(answered) = classes.get_mut(column) {
                    answered.predicted += count;
                }
            }
        }
        SegmentationScores { classes }
    }
}

/// Pixels of one class.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct ClassPixels {
    /// Answered rightly.
    pub hits: u64,
    /// Of the class.
    pub truth: u64,
    /// Answered with the class.
    pub predicted: u64,
}

impl ClassPixels {
    /// Intersection over union; `None` for a class that neither is there nor answered.
    pub fn iou(&self) -> Option<f64> {
        ratio(self.hits, self.truth + self.predicted - self.hits)
    }

    /// Share of its pixels that were found; `None` for a class that is not there.
    pub fn accuracy(&self) -> Option<f64> {
        ratio(self.hits, self.truth)
    }
}

/// The outcome, by class number.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct SegmentationScores {
    /// Pixels of each class.
    pub classes: Vec<ClassPixels>,
}

impl SegmentationScores {
    fn total(&self, number: fn(&ClassPixels) -> u64) -> u64 {
        self.classes.iter().map(number).sum()
    }

    /// Mean intersection over union of the classes that are there or answered.
    pub fn mean_iou(&self) -> Option<f64> {
        mean(self.classes.iter().filter_map(ClassPixels::iou))
    }

    /// Share of all pixels that are right.
    pub fn pixel_accuracy(&self) -> Option<f64> {
        ratio(self.total(|class| class.hits), self.total(|class| class.truth))
    }

    /// Mean accuracy of the classes that are there.
    pub fn mean_accuracy(&self) -> Option<f64> {
        mean(self.classes.iter().filter_map(ClassPixels::accuracy))
    }

    /// Intersection over union weighted by the share of the class of all pixels (Long et al., 2015).
    pub fn frequency_weighted_iou(&self) -> Option<f64> {
        let total = self.total(|class| class.truth);
        let part = |class: &ClassPixels| class.iou().unwrap_or(0.0) * class.truth as f64;
        (total > 0).then(|| self.classes.iter().map(part).sum::<f64>() / total as f64)
    }
}

/// Counts pixels. Memory grows with the square of the highest class number, not with the pictures.
#[derive(Debug, Clone, Default)]
pub struct Segmentation {
    params: SegmentationParams,
    names: Classes,
    pixels: Pixels,
}

impl Segmentation {
    /// Counts the pixels of one picture and gives its scores. Pixels whose truth is the ignored label do not count; an
    /// answer of the ignored label, or of [`Heatmap::NO_CLASS`], is a miss that burdens no other class.
    ///
    /// # Errors
    /// `InvalidInput` when the maps differ in size or a label is above 1023 and not the ignored one.
    pub fn add(&mut self, truth: &[u32], predicted: &[u32]) -> Result<SegmentationScores> {
        if truth.len() != predicted.len() {
            let (wanted, given) = (truth.len(), predicted.len());
            return Err(Error::invalid_input(format!(
                "a map of {given} pixels cannot answer one of {wanted}; give maps of the same size"
            )));
        }
        let ignore = self.params.ignore;
        // A label that is not counted stands for class 0, which there always is.
        let none = ignore.unwrap_or(0);
        let highest = |labels: &[u32], uncounted: u32| {
            let counted = labels.iter().filter(|label| ![none, uncounted].contains(label));
            counted.max().copied().unwrap_or(0)
        };
        let highest = highest(truth, none).max(highest(predicted, Heatmap::NO_CLASS)) as usize;
        if highest >= MAX_CLASSES {
            return Err(Error::invalid_input(format!(
                "label {highest} is no class number below {MAX_CLASSES} and not the ignored label {ignore:?}"
            )));
        }
        let mut picture = Pixels::new(highest + 1);
        picture.count(truth, predicted);
        self.pixels.add(&picture);
        Ok(picture.scores(ignore))
    }

    /// Scores of all pixels counted.
    pub fn scores(&self) -> SegmentationScores {
        self.pixels.scores(self.params.ignore)
    }

    fn name(&self, class: usize) -> String {
        self.names.name(class as i64).map_or_else(|| class.to_string(), |name| name.to_string())
    }

    /// The classes that are there or answered, with their numbers.
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

/// A prediction may be scores `[classes, height, width]`: the highest is the answer.
impl Metric for Segmentation {
    const NAME: &'static str = "segmentation";
    const ABOUT: &'static str = "mean IoU, IoU of classes and pixel accuracies of label maps";
    const NUMBERS: &'static [(&'static str, &'static str)] = &[
        ("miou", "Mean over classes of intersection over union."),
        ("pixel_accuracy", "Share of right pixels."),
        ("mean_accuracy", "Mean over classes of the share of right pixels."),
        ("frequency_weighted_iou", "Intersection over union, weighted by pixels of the class."),
        ("pixels", "Pixels that were counted."),
    ];
    type Params = SegmentationParams;
    type Prediction = Heatmap;
    type Truth = Heatmap;

    fn new(params: &SegmentationParams) -> Result<Self> {
        Ok(Self { params: params.clone(), ..Self::default() })
    }

    fn update(&mut self, _at: usize, prediction: &Heatmap, truth: &Heatmap) -> Result<f64> {
        let HeatmapValues::Labels(wanted) = truth.values() else {
            return Err(Error::invalid_input("the truth of segmentation is a map of labels, not of scores"));
        };
        let (given, shape) = prediction.class_labels()?;
        if shape != truth.shape() {
            let wanted = truth.shape();
            return Err(Error::invalid_input(format!(
                "a map of shape {shape:?} cannot answer one of {wanted:?}; resize the prediction to the truth"
            )));
        }
        let scores = self.add(wanted, &given)?;
        if self.names.is_empty() {
            let names = if truth.classes.is_empty() { &prediction.classes } else { &truth.classes };
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
            ("pixels", Some(scores.total(|class| class.truth) as f64)),
            ("miou", scores.mean_iou()),
            ("pixel_accuracy", scores.pixel_accuracy()),
            ("mean_accuracy", scores.mean_accuracy()),
            ("frequency_weighted_iou", scores.frequency_weighted_iou()),
        ];
        for (key, value) in numbers {
            report.statistics.set(key, value.unwrap_or(f64::NAN));
        }
        let present =
            scores.classes.iter().enumerate().filter(|(_, class)| class.truth + class.predicted > 0);
        let row = |(at, class): (usize, &ClassPixels)| {
            (self.name(at), vec![class.iou(), class.accuracy(), Some(class.truth as f64)])
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
