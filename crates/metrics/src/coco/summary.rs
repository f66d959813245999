//! Metrics, tables and figures of a COCO evaluation.

use super::curve::Curve;
use super::protocol::{Protocol, RECALLS, THRESHOLDS, recalls};
use crate::average::mean;
use crate::{Curves, Figure, Line, Report, Table};

/// Keys of the metrics, with descriptions.
pub const NUMBERS: &[(&str, &str)] = &[
    ("map", "Average precision, mean over IoU .50 to .95 and classes."),
    ("map50", "Average precision at IoU .50."),
    ("map75", "Average precision at IoU .75."),
    (
        "map_<area>",
        "Average precision of objects that are `small` (below 32x32 pixels), `medium` (below 96x96) or `large`.",
    ),
    ("mar", "Average recall with all predictions, mean over IoU .50 to .95 and classes."),
    (
        "mar<n>",
        "Average recall with the n best predictions per image; for keypoints, at similarity .50 and .75.",
    ),
    ("mar_<area>", "Average recall of objects of that size."),
];

/// Result of one class.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct ClassOutcome {
    /// Number of objects that count.
    pub ground_truths: u64,
    /// Recall at each limit of detections; `None` without objects.
    pub recalls: Vec<Option<f64>>,
    /// Curve in each range of area; `None` without objects.
    pub curves: Vec<Option<Curve>>,
}

/// Result of an evaluation, by class.
#[derive(Debug, Clone, PartialEq)]
pub struct Outcome<K> {
    protocol: Protocol,
    classes: Vec<(K, ClassOutcome)>,
}

/// Thresholds with keys of their own.
const ALONE: [(usize, &str); 2] = [(0, "50"), (5, "75")];

impl<K> Outcome<K> {
    pub(super) fn new(protocol: &Protocol, classes: Vec<(K, ClassOutcome)>) -> Self {
        Self { protocol: protocol.clone(), classes }
    }

    /// Returns the metrics in the order of pycocotools' `stats` (12 for boxes and masks, 10 for keypoints); -1 if there are no
    /// objects.
    pub fn stats(&self) -> Vec<f64> {
        self.numbers().into_iter().map(|(_, number)| number.unwrap_or(-1.0)).collect()
    }

    /// Returns the metrics with their keys, in the order of [`Outcome::stats`].
    ///
    /// `map` is COCO's AP, `map50` that at an overlap of .5, `map_small` that of small objects. `mar` is AR with the highest
    /// limit of detections, `mar1` and `mar10` with at most 1 and 10 per image.
    pub fn numbers(&self) -> Vec<(String, Option<f64>)> {
        let areas = || self.protocol.areas.iter().enumerate().skip(1);
        let mut numbers = vec![("map".to_owned(), self.average(0, Curve::mean))];
        for (threshold, name) in ALONE {
            numbers.push((format!("map{name}"), self.average(0, |curve| curve.average(threshold))));
        }
        for (at, area) in areas() {
            numbers.push((format!("map_{}", area.name), self.average(at, Curve::mean)));
        }
        let highest = self.protocol.limits.len().saturating_sub(1);
        for at in 0..highest {
            let recall = mean(self.classes.iter().filter_map(|(_, class)| class.recalls[at]));
            numbers.push((format!("mar{}", [1, 10][at.min(1)]), recall));
        }
        numbers.push(("mar".to_owned(), self.average(0, mean_recall)));
        if highest == 0 {
            for (threshold, name) in ALONE {
                numbers.push((format!("mar{name}"), self.average(0, |curve| curve.recall[threshold])));
            }
        }
        for (at, area) in areas() {
            numbers.push((format!("mar_{}", area.name), self.average(at, mean_recall)));
        }
        numbers
    }

    /// Returns the metrics, a table by class and precision-recall curves; `label` returns the name of a class.
    pub fn report(&self, label: impl Fn(&K) -> String) -> Report {
        let mut report = Report::new("map");
        for (key, number) in self.numbers() {
            report.statistics.set(key, number.unwrap_or(f64::NAN));
        }
        report.tables.extend(self.table(label));
        report.figures.extend(self.figure());
        report
    }

    /// Returns the mean of a number over the classes that have objects in range of area `at`.
    fn average(&self, at: usize, number: impl Fn(&Curve) -> f64) -> Option<f64> {
        mean(self.classes.iter().filter_map(|(_, class)| class.curves[at].as_ref().map(&number)))
    }

    fn table(&self, label: impl Fn(&K) -> String) -> Option<Table> {
        let counted = self.classes.iter().filter(|(_, class)| class.ground_truths > 0);
        let rows: Vec<_> = counted
            .map(|(class, outcome)| {
                let number = |number: &dyn Fn(&Curve) -> f64| outcome.curves[0].as_ref().map(number);
                let numbers = vec![
                    Some(outcome.ground_truths as f64),
                    number(&Curve::mean),
                    number(&|curve| curve.average(ALONE[0].0)),
                    number(&|curve| curve.average(ALONE[1].0)),
                    number(&mean_recall),
                ];
                (label(class), numbers)
            })
            .collect();
        let columns = ["ground_truth", "map", "map50", "map75", "mar"].map(str::to_owned).to_vec();
        (!rows.is_empty()).then(|| Table { name: "class".to_owned(), columns, rows })
    }

    fn figure(&self) -> Option<Figure> {
        let curves: Vec<_> = self.classes.iter().filter_map(|(_, class)| class.curves[0].as_ref()).collect();
        if curves.is_empty() {
            return None;
        }
        let line = |label: &str, thresholds: std::ops::Range<usize>| {
            let precision = |level: usize| {
                let of_class = |curve: &&Curve| mean(thresholds.clone().map(|at| curve.precision[at][level]));
                mean(curves.iter().filter_map(of_class)).unwrap_or_default()
            };
            let points = recalls().into_iter().zip((0..RECALLS).map(precision));
            Line { label: label.to_owned(), points: points.map(|(x, y)| [x, y]).collect() }
        };
        Some(Figure::Curves(Curves {
            name: "precision_recall".to_owned(),
            title: "Precision over recall, mean of the classes".to_owned(),
            x: "recall".to_owned(),
            y: "precision".to_owned(),
            lines: vec![line("IoU .50", 0..1), line("IoU .75", 5..6), line("IoU .50:.95", 0..THRESHOLDS)],
        }))
    }
}

fn mean_recall(curve: &Curve) -> f64 {
    curve.recall.iter().sum::<f64>() / THRESHOLDS as f64
}
