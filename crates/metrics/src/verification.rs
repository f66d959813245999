//! Verification of pairs (same face or person, or not): ROC, accuracy as LFW, TAR at FAR, equal error rate.

use opendr_engine::params::Params;
use opendr_engine::target::Category;
use opendr_engine::{Error, Result};

use crate::{Metric, Report, RocCurve, RocPoint, Table};

/// Parameters of [`Verification`].
#[derive(Debug, Clone, Params)]
pub struct VerificationParams {
    /// Number of folds of the cross-validation that selects the threshold: consecutive pairs, as in LFW's file.
    #[param(default = 10, range = 2..=1000)]
    pub folds: usize,
    /// False accept rates at which the true accept rate is reported.
    #[param(default = vec![1e-1, 1e-2, 1e-3, 1e-4], range = 0.0..=1.0)]
    pub false_accept_rates: Vec<f64>,
}

/// One pair.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Pair {
    /// Index in the data set.
    at: usize,
    /// Similarity: pairs with at least a threshold are predicted to be the same.
    score: f64,
    same: bool,
}

/// Result of one fold of the cross-validation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FoldAccuracy {
    /// Best threshold on all other folds; infinite if it is best to accept no pair.
    pub threshold: f64,
    /// Fraction of correct pairs of the fold.
    pub accuracy: f64,
}

/// Collects the scores of pairs: 24 bytes per pair.
#[derive(Debug, Clone, Default)]
pub struct Verification {
    params: VerificationParams,
    pairs: Vec<Pair>,
}

impl Verification {
    /// Adds pair `at` of the data set; a higher score means more similar.
    ///
    /// # Errors
    /// Returns `InvalidInput` for a score that is NaN or infinite.
    pub fn add(&mut self, at: usize, same: bool, score: f64) -> Result<()> {
        if !score.is_finite() {
            return Err(Error::invalid_input(format!(
                "score {score} of pair {at} is not finite; give finite numbers"
            )));
        }
        self.pairs.push(Pair { at, score, same });
        Ok(())
    }

    /// Returns the receiver operating characteristic.
    pub fn curve(&self) -> RocCurve {
        RocCurve::new(self.pairs.iter().map(|pair| (pair.score, pair.same)).collect())
    }

    /// Returns the accuracy on each fold with the threshold that is best on the other folds (Huang et al., Labeled Faces
    /// in the Wild, 2007). Folds are consecutive pairs by index, the first ones longer by one if the division leaves a
    /// remainder (scikit-learn's `KFold`). A threshold is one of the scores of the other folds, or infinite; of equally
    /// good ones the highest. `None` for fewer pairs than folds.
    pub fn fold_accuracies(&self) -> Option<Vec<FoldAccuracy>> {
        let (count, folds) = (self.pairs.len(), self.params.folds);
        let mut pairs = self.pairs.clone();
        pairs.sort_by_key(|pair| pair.at);
        let longer = count % folds * (count / folds + 1);
        let fold_of = |place: usize| match place < longer {
            true => place / (count / folds + 1),
            false => count % folds + (place - longer) / (count / folds),
        };
        if count < folds {
            return None;
        }
        let mut ranked: Vec<(usize, Pair)> =
            pairs.into_iter().enumerate().map(|(place, pair)| (fold_of(place), pair)).collect();
        ranked.sort_by(|(_, one), (_, other)| other.score.total_cmp(&one.score));
        Some((0..folds).map(|fold| accuracy_of_fold(&ranked, fold)).collect())
    }
}

/// Computes the accuracy of a fold. `ranked` has the fold of each pair and the pair, highest score first.
fn accuracy_of_fold(ranked: &[(usize, Pair)], fold: usize) -> FoldAccuracy {
    let (mut correct, mut best) = (0_i64, 0_i64);
    let mut threshold = f64::INFINITY;
    for tied in ranked.chunk_by(|(_, one), (_, other)| one.score == other.score) {
        // Accepting them adds one per pair of the same and subtracts one per other pair.
        let gain = |(_, pair): &(usize, Pair)| if pair.same { 1 } else { -1 };
        correct += tied.iter().filter(|(part, _)| *part != fold).map(gain).sum::<i64>();
        if correct > best {
            (best, threshold) = (correct, tied[0].1.score);
        }
    }
    let tested = ranked.iter().filter(|(part, _)| *part == fold).map(|(_, pair)| pair);
    let (mut hits, mut count) = (0, 0);
    for pair in tested {
        hits += u32::from((pair.score >= threshold) == pair.same);
        count += 1;
    }
    FoldAccuracy { threshold, accuracy: f64::from(hits) / f64::from(count.max(1)) }
}

impl RocCurve {
    /// Returns the point of the highest true accept rate whose false accept rate is at most `rate`, without
    /// interpolation: with fewer than `1 / rate` negatives it is a point without false accepts. `None` without positives
    /// or negatives.
    pub fn at_false_accept_rate(&self, rate: f64) -> Option<RocPoint> {
        let allowed = |point: &&RocPoint| self.rates(point).is_some_and(|[accepted, _]| accepted <= rate);
        self.points().iter().rev().find(allowed).copied()
    }

    /// Returns the rate at which false accepts and false rejects are equally frequent, by linear interpolation between
    /// the two nearest points; `None` without positives or negatives.
    pub fn equal_error_rate(&self) -> Option<f64> {
        let rates = self.points().iter().map(|point| self.rates(point)).collect::<Option<Vec<_>>>()?;
        let excess = |[accepted, found]: [f64; 2]| accepted - (1.0 - found);
        let crossed = rates.iter().position(|point| excess(*point) >= 0.0)?;
        let (before, after) = (rates[crossed.max(1) - 1], rates[crossed]);
        let share = excess(before) / (excess(before) - excess(after));
        Some(before[0] + share * (after[0] - before[0]))
    }

    /// Returns the point of the highest accuracy and that accuracy; of equal ones the point with the highest threshold.
    /// `None` without samples.
    pub fn best_accuracy(&self) -> Option<(RocPoint, f64)> {
        let right = |point: &RocPoint| point.true_positives + (self.negatives() - point.false_positives);
        let count = self.positives() + self.negatives();
        let best = self.points().iter().rev().max_by_key(|point| right(point))?;
        (count > 0).then(|| (*best, right(best) as f64 / count as f64))
    }
}

/// The score of a prediction is its confidence, for any class; ground truth is class 1 for the same, another for different.
impl Metric for Verification {
    const NAME: &'static str = "verification";
    const ABOUT: &'static str = "accuracy of pairs by cross-validation as LFW, ROC, TAR at FAR and EER";
    const NUMBERS: &'static [(&'static str, &'static str)] = &[
        ("accuracy", "Mean over folds of the accuracy at the best threshold of the other folds, as LFW."),
        ("accuracy_standard_error", "Standard error of the accuracy over the folds."),
        ("best_accuracy", "Accuracy at the best threshold."),
        ("best_threshold", "Best threshold."),
        ("roc_auc", "Area under the ROC curve."),
        ("equal_error_rate", "Rate at which false accepts and false rejects are equally frequent."),
        ("tar_at_far_<rate>", "True accept rate at the given false accept rate."),
        ("same", "Number of pairs of the same."),
        ("different", "Number of pairs of different ones."),
    ];
    const LOWER_IS_BETTER: &'static [&'static str] = &["accuracy_standard_error", "equal_error_rate"];
    type Params = VerificationParams;
    type Prediction = Category;
    type GroundTruth = Category;

    fn new(params: &VerificationParams) -> Result<Self> {
        Ok(Self { params: params.clone(), pairs: Vec::new() })
    }

    fn update(&mut self, at: usize, prediction: &Category, ground_truth: &Category) -> Result<f64> {
        let Some(score) = prediction.confidence else {
            return Err(Error::invalid_input(format!(
                "pair {at} has no confidence; give its similarity as confidence"
            )));
        };
        let (score, same) = (f64::from(score), ground_truth.class == 1);
        self.add(at, same, score)?;
        Ok((if same { score } else { 1.0 - score }).clamp(0.0, 1.0))
    }

    fn merge(&mut self, other: Self) {
        self.pairs.extend(other.pairs);
    }

    fn finish(&self) -> Report {
        let mut report = Report::new("accuracy");
        let curve = self.curve();
        let mut set = |key: String, value: Option<f64>| report.statistics.set(key, value.unwrap_or(f64::NAN));
        set("same".into(), Some(curve.positives() as f64));
        set("different".into(), Some(curve.negatives() as f64));
        set("roc_auc".into(), curve.area());
        set("equal_error_rate".into(), curve.equal_error_rate());
        for rate in &self.params.false_accept_rates {
            let point = curve.at_false_accept_rate(*rate);
            let accepted = point.and_then(|point| curve.rates(&point)).map(|[_, found]| found);
            set(format!("tar_at_far_{rate:e}"), accepted);
        }
        if let Some((point, accuracy)) = curve.best_accuracy() {
            set("best_accuracy".into(), Some(accuracy));
            set("best_threshold".into(), Some(point.threshold));
        }
        if let Some(folds) = self.fold_accuracies() {
            let count = folds.len() as f64;
            let mean = folds.iter().map(|fold| fold.accuracy).sum::<f64>() / count;
            let spread = folds.iter().map(|fold| (fold.accuracy - mean).powi(2)).sum::<f64>();
            set("accuracy".into(), Some(mean));
            set("accuracy_standard_error".into(), Some((spread / (count - 1.0) / count).sqrt()));
            report.tables.push(table_of_folds(&folds));
        }
        report.figures.extend(curve.figure());
        report
    }
}

fn table_of_folds(folds: &[FoldAccuracy]) -> Table {
    let finite = |number: f64| Some(number).filter(|number| number.is_finite());
    let row = |(at, fold): (usize, &FoldAccuracy)| {
        ((at + 1).to_string(), vec![Some(fold.accuracy), finite(fold.threshold)])
    };
    Table {
        name: "fold".to_owned(),
        columns: ["accuracy", "threshold"].map(str::to_owned).into(),
        rows: folds.iter().enumerate().map(row).collect(),
    }
}

#[cfg(test)]
mod tests;
