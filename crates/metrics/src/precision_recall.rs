//! Precision, recall and F1 of classes and their averages, as scikit-learn's `precision_recall_fscore_support`.

use crate::average;

opendr_engine::choices! {
    /// What precision, recall and F1 are where their denominator is zero (scikit-learn's `zero_division`).
    pub enum ZeroDivision {
        /// 0.
        Zero = "zero",
        /// 1.
        One = "one",
        /// Undefined, and left out of averages (`np.nan`).
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

/// How often a class was right, answered, and there.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct ClassCounts {
    /// Samples of the class that were answered with it.
    pub hits: u64,
    /// Samples answered with the class.
    pub predicted: u64,
    /// Samples of the class.
    pub support: u64,
}

/// Precision, recall and F1, each 0..=1; `None` where undefined.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct PrecisionRecall {
    /// Share of the answers that are right.
    pub precision: Option<f64>,
    /// Share of the samples that were found.
    pub recall: Option<f64>,
    /// Harmonic mean of both.
    pub f1: Option<f64>,
}

impl PrecisionRecall {
    /// Of one class against all others.
    pub fn new(counts: ClassCounts, zero: ZeroDivision) -> Self {
        Self {
            precision: zero.divide(counts.hits, counts.predicted),
            recall: zero.divide(counts.hits, counts.support),
            f1: zero.divide(2 * counts.hits, counts.support + counts.predicted),
        }
    }

    /// Weighted averages, undefined numbers left out; plain ones where all weights are zero.
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
    /// The class.
    pub label: i64,
    /// Samples of the class.
    pub support: u64,
    /// Of the class against all others.
    pub scores: PrecisionRecall,
}

/// Precision, recall and F1 of every class, and their averages.
#[derive(Debug, Clone, PartialEq)]
pub struct ClassScores {
    /// In the order given.
    pub classes: Vec<ClassScore>,
    /// From the counts of all classes together.
    pub micro: PrecisionRecall,
    /// Mean over the classes.
    pub macro_: PrecisionRecall,
    /// Mean over the classes, each weighted by its samples.
    pub weighted: PrecisionRecall,
}

impl ClassScores {
    /// The scores of classes by their counts.
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
        // All weights are zero: the plain mean, as scikit-learn.
        assert_eq!(ClassScores::new([counts[2]], ZeroDivision::One).weighted.f1, Some(1.0));
    }
}
