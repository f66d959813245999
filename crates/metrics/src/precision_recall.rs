//! Precision, recall and F1 of classes and their averages, equal to scikit-learn's `precision_recall_fscore_support`.

use crate::average;

opendr_engine::choices! {
    /// Value of precision, recall and F1 where the denominator is zero (scikit-learn's `zero_division`).
    pub enum ZeroDivision {
        /// 0.
        Zero = "zero",
        /// 1.
        One = "one",
        /// Undefined, and excluded from averages (`np.nan`).
        Undefined = "undefined",
    }
}

impl ZeroDivision {
    fn divide(self, numerator: u64, denominator: u64) -> Option<f64> {
        match self {
            _ if denominator > 0 => Some(numerator as f64 / denominator as f64),
            Self::Zero => Some(0.0),
            Self::One => Some(1.0),
            Self::Undefined => None,
        }
    }
}

/// Counts of one class.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct ClassCounts {
    /// Samples of the class that are predicted as the class.
    pub hits: u64,
    /// Samples predicted as the class.
    pub predicted: u64,
    /// Samples of the class.
    pub support: u64,
}

/// Precision, recall and F1, each 0..=1; `None` if undefined.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct PrecisionRecall {
    /// Fraction of the predictions that are correct.
    pub precision: Option<f64>,
    /// Fraction of the samples that are detected.
    pub recall: Option<f64>,
    /// Harmonic mean of both.
    pub f1: Option<f64>,
}

impl PrecisionRecall {
    /// Computes the scores of one class against all others.
    pub fn new(counts: ClassCounts, zero: ZeroDivision) -> Self {
        Self {
            precision: zero.divide(counts.hits, counts.predicted),
            recall: zero.divide(counts.hits, counts.support),
            f1: zero.divide(2 * counts.hits, counts.support + counts.predicted),
        }
    }

    /// Returns weighted averages of defined numbers, or plain averages if all weights are zero.
    fn average(classes: &[ClassScore], weight: fn(&ClassScore) -> f64) -> Self {
        let mean = |number: fn(&Self) -> Option<f64>| {
            let defined = || classes.iter().filter_map(|class| Some((number(&class.scores)?, weight(class))));
            let total: f64 = defined().map(|(_, weight)| weight).sum();
            if total > 0.0 {
                return Some(defined().map(|(value, weight)| value * weight).sum::<f64>() / total);
            }
            average::mean(defined().map(|(value, _)| value))
        };
        Self { precision: mean(|scores| scores.precision), recall: mean(|s| s.recall), f1: mean(|s| s.f1) }
    }
}

/// One class of [`ClassScores`].
#[derive(Debug, Clone, PartialEq)]
pub struct ClassScore {
    /// Class index.
    pub label: i64,
    /// Number of samples of the class.
    pub support: u64,
    /// Scores of the class against all others.
    pub scores: PrecisionRecall,
}

/// Precision, recall and F1 of every class, and their averages.
#[derive(Debug, Clone, PartialEq)]
pub struct ClassScores {
    /// Scores by class, in the given order.
    pub classes: Vec<ClassScore>,
    /// Scores from the counts of all classes together.
    pub micro: PrecisionRecall,
    /// Means over the classes.
    pub macro_: PrecisionRecall,
    /// Means over the classes, weighted by their samples.
    pub weighted: PrecisionRecall,
}

impl ClassScores {
    /// Computes the scores from the counts by class.
    pub fn new(counts: impl IntoIterator<Item = (i64, ClassCounts)>, zero: ZeroDivision) -> Self {
        let mut total = ClassCounts::default();
        let mut classes = Vec::new();
        for (label, class) in counts {
            total.hits += class.hits;
            total.predicted += class.predicted;
            total.support += class.support;
            let scores = PrecisionRecall::new(class, zero);
            classes.push(ClassScore { label, support: class.support, scores });
        }
        Self {
            micro: PrecisionRecall::new(total, zero),
            macro_: PrecisionRecall::average(&classes, |_| 1.0),
            weighted: PrecisionRecall::average(&classes, |class| class.support as f64),
            classes,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn class_that_never_occurs() {
        let counts = [
            (0, ClassCounts { hits: 1, predicted: 1, support: 2 }),
            (1, ClassCounts { hits: 0, predicted: 1, support: 0 }),
            (7, ClassCounts::default()),
        ];
        let f1 = |zero| ClassScores::new(counts, zero).macro_.f1;
        assert_eq!(f1(ZeroDivision::Zero), Some(2.0 / 9.0));
        assert_eq!(f1(ZeroDivision::One), Some((2.0 / 3.0 + 1.0) / 3.0));
        assert_eq!(f1(ZeroDivision::Undefined), Some(1.0 / 3.0));
        let alone = ClassScores::new([counts[2]], ZeroDivision::Undefined);
        assert_eq!(alone.weighted, PrecisionRecall::default());
        // All weights are zero: the plain mean, as in scikit-learn.
        assert_eq!(ClassScores::new([counts[2]], ZeroDivision::One).weighted.f1, Some(1.0));
    }
}
