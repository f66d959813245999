//! Receiver operating characteristic and precision-recall curve, equal to scikit-learn, including ties.

use opendr_engine::params::Params;
use opendr_engine::target::Category;
use opendr_engine::{Error, Result};

use crate::{Curves, Figure, Line, Metric, Report};

/// Maximum number of points of a drawn line.
const DRAWN_POINTS: usize = 1000;

/// Numbers of negatives (`false_positives`) and positives (`true_positives`) with a score of at least `threshold`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RocPoint {
    /// Threshold: samples with at least this score are predicted positive.
    pub threshold: f64,
    /// Negatives predicted positive.
    pub false_positives: u64,
    /// Positives predicted positive.
    pub true_positives: u64,
}

/// A [`RocPoint`] for every score that occurs, highest first, after one at infinity where nothing is predicted positive.
#[derive(Debug, Clone, PartialEq)]
pub struct RocCurve {
    points: Vec<RocPoint>,
    positives: u64,
    negatives: u64,
}

impl RocCurve {
    /// Computes the curve of samples (score, is positive), in any order; scores are not NaN.
    pub fn new(mut samples: Vec<(f64, bool)>) -> Self {
        samples.sort_unstable_by(|one, other| other.0.total_cmp(&one.0));
        let (mut positives, mut negatives) = (0, 0);
        let mut points = vec![RocPoint { threshold: f64::INFINITY, false_positives: 0, true_positives: 0 }];
        // Compared by `==`, so that 0 and -0 are one score.
        for tied in samples.chunk_by(|one, other| one.0 == other.0) {
            let hits = tied.iter().filter(|(_, positive)| *positive).count();
            positives += hits as u64;
            negatives += (tied.len() - hits) as u64;
            let threshold = tied[0].0;
            points.push(RocPoint { threshold, false_positives: negatives, true_positives: positives });
        }
        Self { points, positives, negatives }
    }

    /// Returns the points in order of descending thresholds and ascending counts.
    pub fn points(&self) -> &[RocPoint] {
        &self.points
    }

    /// Returns the number of positives.
    pub fn positives(&self) -> u64 {
        self.positives
    }

    /// Returns the number of negatives.
    pub fn negatives(&self) -> u64 {
        self.negatives
    }

    /// Returns the points at which the curve bends, as scikit-learn's `roc_curve` does.
    pub fn corners(&self) -> Vec<RocPoint> {
        let turns = |at: usize| {
            // The point at infinity is not compared: the first score is always kept.
            let (Some(before), Some(after)) = (self.points.get(at - 1), self.points.get(at + 1)) else {
                return true;
            };
            let here = self.points[at];
            at == 1
                || here.false_positives - before.false_positives
                    != after.false_positives - here.false_positives
                || here.true_positives - before.true_positives != after.true_positives - here.true_positives
        };
        let kept = self.points.iter().enumerate().filter(|(at, _)| *at == 0 || turns(*at));
        kept.map(|(_, point)| *point).collect()
    }

    /// Returns the false and true positive rate at `point`; `None` without negatives or without positives.
    pub fn rates(&self, point: &RocPoint) -> Option<[f64; 2]> {
        (self.positives > 0 && self.negatives > 0).then(|| {
            [
                point.false_positives as f64 / self.negatives as f64,
                point.true_positives as f64 / self.positives as f64,
            ]
        })
    }

    /// Returns the area under the curve by the trapezoidal rule (`roc_auc_score`); `None` without positives or negatives.
    pub fn area(&self) -> Option<f64> {
        // Twice the area in integers, hence exact.
        let steps = self.points.windows(2).map(|pair| {
            let width = pair[1].false_positives - pair[0].false_positives;
            u128::from(width) * u128::from(pair[1].true_positives + pair[0].true_positives)
        });
        let whole = 2 * u128::from(self.positives) * u128::from(self.negatives);
        (whole > 0).then(|| steps.sum::<u128>() as f64 / whole as f64)
    }

    /// Returns the precision at every rise of recall, weighted by the rise (`average_precision_score`); `None` without
    /// positives.
    pub fn average_precision(&self) -> Option<f64> {
        let steps = self.points.windows(2).map(|pair| {
            let rise = pair[1].true_positives - pair[0].true_positives;
            rise as f64 * precision(&pair[1])
        });
        (self.positives > 0).then(|| steps.sum::<f64>() / self.positives as f64)
    }

    /// Returns the point with the highest F1 and that F1; of equal ones the point with the lowest threshold. `None` without
    /// positives.
    pub fn best_f1(&self) -> Option<(RocPoint, f64)> {
        let f1 = |point: &RocPoint| {
            let predicted = point.true_positives + point.false_positives;
            2.0 * point.true_positives as f64 / (predicted + self.positives) as f64
        };
        let scored = self.points.iter().skip(1).map(|point| (*point, f1(point)));
        // `max_by` returns the last of equal ones.
        scored.filter(|_| self.positives > 0).max_by(|one, other| one.1.total_cmp(&other.1))
    }

    /// Returns the figure of the curve.
    pub(crate) fn figure(&self) -> Option<Figure> {
        let points = self.corners().iter().map(|point| self.rates(point)).collect::<Option<Vec<_>>>()?;
        let chance = Line { label: "chance".to_owned(), points: vec![[0.0, 0.0], [1.0, 1.0]] };
        Some(Figure::Curves(Curves {
            name: "roc".to_owned(),
            title: "Receiver operating characteristic".to_owned(),
            x: "false positive rate".to_owned(),
            y: "true positive rate".to_owned(),
            lines: vec![chance, Line { label: "predictions".to_owned(), points: thinned(points) }],
        }))
    }

    fn precision_figure(&self) -> Option<Figure> {
        let whole = self.positives as f64;
        let point = |point: &RocPoint| [point.true_positives as f64 / whole, precision(point)];
        let points = self.points.iter().skip(1).map(point).collect();
        (self.positives > 0).then(|| {
            Figure::Curves(Curves {
                name: "precision_recall".to_owned(),
                title: "Precision and recall".to_owned(),
                x: "recall".to_owned(),
                y: "precision".to_owned(),
                lines: vec![Line { label: "predictions".to_owned(), points: thinned(points) }],
            })
        })
    }
}

fn precision(point: &RocPoint) -> f64 {
    point.true_positives as f64 / (point.true_positives + point.false_positives).max(1) as f64
}

/// Returns evenly spaced points, including the first and the last.
fn thinned(points: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
    if points.len() <= DRAWN_POINTS {
        return points;
    }
    let last = points.len() - 1;
    (0..DRAWN_POINTS).map(|at| points[at * last / (DRAWN_POINTS - 1)]).collect()
}

/// Parameters of [`Roc`].
#[derive(Debug, Clone, Params)]
pub struct RocParams {
    /// Positive class, e.g. the anomaly; all others are negative.
    #[param(default = 1)]
    pub positive: i64,
}

/// Collects the scores of positives and negatives: 16 bytes per sample.
#[derive(Debug, Clone, Default)]
pub struct Roc {
    params: RocParams,
    samples: Vec<(f64, bool)>,
}

impl Roc {
    /// Adds a sample; a high score means positive.
    ///
    /// # Errors
    /// Returns `InvalidInput` for a score that is NaN or infinite.
    pub fn add(&mut self, positive: bool, score: f64) -> Result<()> {
        if !score.is_finite() {
            return Err(Error::invalid_input(format!("score {score} is not finite; give finite numbers")));
        }
        self.samples.push((score, positive));
        Ok(())
    }

    /// Returns the curve of the samples.
    pub fn curve(&self) -> RocCurve {
        RocCurve::new(self.samples.clone())
    }
}

/// The score of a prediction is the probability of the positive class; without probabilities its confidence, or one minus
/// the confidence if it predicts another class.
impl Metric for Roc {
    const NAME: &'static str = "roc";
    const ABOUT: &'static str = "ROC and precision-recall of one class against the others, as scikit-learn";
    const NUMBERS: &'static [(&'static str, &'static str)] = &[
        ("roc_auc", "Area under the ROC curve."),
        ("average_precision", "Area under the precision-recall curve, as a step function."),
        ("best_f1", "Highest F1 over all thresholds."),
        ("best_f1_threshold", "Threshold of the highest F1."),
        ("positives", "Number of samples of the positive class."),
        ("negatives", "Number of all other samples."),
    ];
    type Params = RocParams;
    type Prediction = Category;
    type GroundTruth = Category;

    fn new(params: &RocParams) -> Result<Self> {
        Ok(Self { params: params.clone(), samples: Vec::new() })
    }

    fn update(&mut self, _at: usize, prediction: &Category, ground_truth: &Category) -> Result<f64> {
        let positive = self.params.positive;
        let own = usize::try_from(positive).ok().and_then(|class| prediction.probabilities.get(class));
        let score = match (own, prediction.confidence) {
            (Some(probability), _) => f64::from(*probability),
            (None, Some(confidence)) if prediction.class == positive => f64::from(confidence),
            (None, Some(confidence)) => 1.0 - f64::from(confidence),
            (None, None) => {
                return Err(Error::invalid_input(format!(
                    "category {} has no score for class {positive}; give a confidence or probabilities",
                    prediction.class
                )));
            }
        };
        let is_positive = ground_truth.class == positive;
        self.add(is_positive, score)?;
        Ok((if is_positive { score } else { 1.0 - score }).clamp(0.0, 1.0))
    }

    fn merge(&mut self, other: Self) {
        self.samples.extend(other.samples);
    }

    fn finish(&self) -> Report {
        let mut report = Report::new("roc_auc");
        let curve = self.curve();
        report.statistics.set("positives", curve.positives() as f64);
        report.statistics.set("negatives", curve.negatives() as f64);
        report.statistics.set("roc_auc", curve.area().unwrap_or(f64::NAN));
        report.statistics.set("average_precision", curve.average_precision().unwrap_or(f64::NAN));
        if let Some((point, f1)) = curve.best_f1() {
            report.statistics.set("best_f1", f1);
            report.statistics.set("best_f1_threshold", point.threshold);
        }
        report.figures.extend(curve.figure());
        report.figures.extend(curve.precision_figure());
        report
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn curve(samples: &[(f64, bool)]) -> RocCurve {
        RocCurve::new(samples.to_vec())
    }

    #[test]
    fn example_of_scikit_learn() {
        let curve = curve(&[(0.1, false), (0.4, false), (0.35, true), (0.8, true)]);
        assert_eq!(curve.area(), Some(0.75));
        assert!((curve.average_precision().unwrap() - 0.8333333333333333).abs() < 1e-12);
        let thresholds: Vec<f64> = curve.corners().iter().map(|point| point.threshold).collect();
        assert_eq!(thresholds, [f64::INFINITY, 0.8, 0.4, 0.35, 0.1]);
        let (point, f1) = curve.best_f1().unwrap();
        assert_eq!((point.threshold, f1), (0.35, 0.8));
    }

    #[test]
    fn ties_are_one_step() {
        let curve = curve(&[(0.5, true), (0.5, false), (0.0, false), (-0.0, true)]);
        assert_eq!(curve.points().len(), 3);
        assert_eq!(curve.area(), Some(0.5));
        assert_eq!(curve.average_precision(), Some(0.5));
    }

    #[test]
    fn one_class_only() {
        let positives = curve(&[(0.5, true), (0.25, true)]);
        assert_eq!((positives.area(), positives.average_precision()), (None, Some(1.0)));
        let negatives = curve(&[(0.5, false)]);
        assert_eq!(
            (negatives.area(), negatives.average_precision(), negatives.best_f1()),
            (None, None, None)
        );
        assert_eq!(curve(&[]).corners().len(), 1);
    }

    #[test]
    fn score_of_the_positive_class() {
        let mut roc = Roc::default();
        let ground_truth = Category::new(1, None);
        let prediction = Category { probabilities: vec![0.25, 0.75], ..Category::new(0, None) };
        assert_eq!(roc.update(0, &prediction, &ground_truth).unwrap(), 0.75);
        assert_eq!(roc.update(1, &Category::new(0, Some(0.75)), &ground_truth).unwrap(), 0.25);
        assert_eq!(roc.update(2, &Category::new(1, Some(0.75)), &ground_truth).unwrap(), 0.75);
        assert!(roc.update(3, &Category::new(1, Some(f32::NAN)), &ground_truth).is_err());
        assert!(roc.update(3, &Category::new(1, None), &ground_truth).is_err());
        assert_eq!(roc.samples.len(), 3);
    }

    #[test]
    fn long_lines_are_thinned() {
        let points = thinned((0..5000).map(|at| [f64::from(at), 0.0]).collect());
        assert_eq!((points.len(), points[0][0], points[DRAWN_POINTS - 1][0]), (DRAWN_POINTS, 0.0, 4999.0));
    }
}
