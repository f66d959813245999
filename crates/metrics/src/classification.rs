//! Classification: accuracy, top-k, precision, recall, F1, confusion matrix and calibration, equal to scikit-learn.

use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use opendr_engine::params::Params;
use opendr_engine::target::{Category, Classes, Name};
use opendr_engine::{Datum, Error, Result, ValueRef};

use crate::average::{mean, ratio};
use crate::{
    Calibration, ClassCounts, ClassScores, Figure, Matrix, Metric, PrecisionRecall, Report, Table,
    ZeroDivision,
};

/// Maximum number of classes of a confusion matrix that is drawn.
const MATRIX_CLASSES: usize = 1000;

/// Maximum number of scores of a sample, which bounds the histogram of ranks.
const MAX_SCORES: usize = 1 << 20;

/// Parameters of [`Classification`].
#[derive(Debug, Clone, Params)]
pub struct ClassificationParams {
    /// Classes to average over; if empty, all that occur as ground truth or prediction.
    pub labels: Vec<i64>,
    /// Value of precision, recall and F1 where the denominator is zero.
    pub zero_division: ZeroDivision,
    /// Values of k for the top-k accuracies.
    #[param(default = vec![5], range = 1..=1_048_576)]
    pub top_k: Vec<usize>,
}

/// Accumulates the confusion matrix. Memory grows with the pairs of classes that occur, not with the samples.
#[derive(Debug, Clone, Default)]
pub struct Classification {
    params: ClassificationParams,
    /// Class names by index.
    names: BTreeMap<i64, Arc<str>>,
    /// Rank of each class of the data set in the order of class names; empty without names.
    order: Vec<usize>,
    /// Number of samples by (ground truth, prediction).
    pairs: BTreeMap<(i64, i64), u64>,
    /// Number of samples by the rank of their class among the scores.
    ranks: Vec<u64>,
    calibration: Calibration,
}

impl Classification {
    /// Adds a sample.
    pub fn add(&mut self, ground_truth: i64, predicted: i64) {
        *self.pairs.entry((ground_truth, predicted)).or_default() += 1;
    }

    /// Adds the rank of the true class among the scores of all classes, from class 0 on, for the top-k accuracies. Of equal
    /// scores the higher class index ranks first, or, if classes have names, the later name, as in scikit-learn's
    /// `top_k_accuracy_score` of numbers and of names.
    ///
    /// # Errors
    /// Returns `InvalidInput` if `ground_truth` has no score, a score is NaN, or there are more than 2^20 scores.
    pub fn add_scores(&mut self, ground_truth: i64, scores: &[f32]) -> Result<()> {
        let rank = rank_of_class(ground_truth, scores, &self.order)?;
        self.add_rank(rank);
        Ok(())
    }

    fn add_rank(&mut self, rank: usize) {
        if self.ranks.len() <= rank {
            self.ranks.resize(rank + 1, 0);
        }
        self.ranks[rank] += 1;
    }

    /// Adds the confidence of a prediction, for the calibration.
    ///
    /// # Errors
    /// As [`Calibration::add`].
    pub fn add_confidence(&mut self, correct: bool, confidence: f64) -> Result<()> {
        self.calibration.add(correct, confidence)
    }

    /// Returns the number of samples.
    pub fn samples(&self) -> u64 {
        self.pairs.values().sum()
    }

    /// Returns the classes that occur as ground truth or prediction, ascending.
    pub fn labels(&self) -> Vec<i64> {
        let labels: BTreeSet<i64> =
            self.pairs.keys().flat_map(|(ground_truth, predicted)| [*ground_truth, *predicted]).collect();
        labels.into_iter().collect()
    }

    /// Returns the fraction of correct predictions; `None` without samples.
    pub fn accuracy(&self) -> Option<f64> {
        let hits = self.pairs.iter().filter(|((ground_truth, predicted), _)| ground_truth == predicted);
        ratio(hits.map(|(_, count)| count).sum(), self.samples())
    }

    /// Returns the mean recall of the classes that have samples; `None` without samples.
    pub fn balanced_accuracy(&self) -> Option<f64> {
        let counts = self.counts();
        mean(counts.values().filter_map(|class| ratio(class.hits, class.support)))
    }

    /// Returns the fraction of samples whose class is among the `k` highest scores; `None` without scores. It is 1 if `k` is
    /// at least the number of classes.
    pub fn top_k(&self, k: usize) -> Option<f64> {
        ratio(self.ranks.iter().take(k).sum(), self.ranks.iter().sum())
    }

    /// Returns the calibration of the confidences.
    pub fn calibration(&self) -> &Calibration {
        &self.calibration
    }

    /// Returns precision, recall and F1 of the classes of [`ClassificationParams::labels`], or of those that occur.
    pub fn scores(&self) -> ClassScores {
        let counts = self.counts();
        let zero = self.params.zero_division;
        if self.params.labels.is_empty() {
            return ClassScores::new(counts, zero);
        }
        let count = |label: &i64| (*label, counts.get(label).copied().unwrap_or_default());
        ClassScores::new(self.params.labels.iter().map(count), zero)
    }

    /// Returns the confusion matrix over `labels` in ascending order: ground truth by row, prediction by column. Other
    /// classes are left out.
    pub fn confusion(&self, labels: &[i64]) -> Vec<u64> {
        let side = labels.len();
        let mut counts = vec![0; side * side];
        for ((ground_truth, predicted), count) in &self.pairs {
            if let (Ok(row), Ok(column)) =
                (labels.binary_search(ground_truth), labels.binary_search(predicted))
            {
                counts[row * side + column] = *count;
            }
        }
        counts
    }

    fn counts(&self) -> BTreeMap<i64, ClassCounts> {
        let mut counts = BTreeMap::<i64, ClassCounts>::new();
        for ((ground_truth, predicted), count) in &self.pairs {
            counts.entry(*predicted).or_default().predicted += count;
            let class = counts.entry(*ground_truth).or_default();
            class.support += count;
            if ground_truth == predicted {
                class.hits += count;
            }
        }
        counts
    }

    fn name(&self, label: i64) -> String {
        self.names.get(&label).map_or_else(|| label.to_string(), |name| name.to_string())
    }

    fn table(&self, scores: &ClassScores) -> Table {
        let rows = scores.classes.iter().map(|class| {
            let PrecisionRecall { precision, recall, f1 } = class.scores;
            (self.name(class.label), vec![precision, recall, f1, Some(class.support as f64)])
        });
        let columns = ["precision", "recall", "f1", "support"].map(str::to_owned).into();
        Table { name: "class".to_owned(), columns, rows: rows.collect() }
    }
}

impl Metric for Classification {
    const NAME: &'static str = "classification";
    const ABOUT: &'static str =
        "accuracy, top-k, precision, recall, F1 and confusion matrix as scikit-learn; calibration error";
    const NUMBERS: &'static [(&'static str, &'static str)] = &[
        ("accuracy", "Fraction of correct predictions."),
        ("balanced_accuracy", "Mean recall over the classes that occur."),
        ("top_<k>_accuracy", "Fraction of samples whose class is among the k highest scores."),
        ("precision_<average>", "Precision, `micro`, `macro` or `weighted` average over classes."),
        ("recall_<average>", "Recall with the same averages."),
        ("f1_<average>", "F1 with the same averages."),
        (
            "expected_calibration_error",
            "Mean difference of confidence and accuracy over 15 bins of confidence, weighted by samples.",
        ),
        ("maximum_calibration_error", "Largest of these differences."),
        ("samples", "Number of samples."),
    ];
    const LOWER_IS_BETTER: &'static [&'static str] =
        &["expected_calibration_error", "maximum_calibration_error"];
    type Params = ClassificationParams;
    type Prediction = Category;
    type GroundTruth = Category;

    fn new(params: &ClassificationParams) -> Result<Self> {
        let mut unique = BTreeSet::new();
        if let Some(label) = params.labels.iter().find(|label| !unique.insert(**label)) {
            return Err(Error::invalid_param(format!(
                "labels contain class {label} twice; give each class once"
            )));
        }
        Ok(Self { params: params.clone(), ..Self::default() })
    }

    fn name_classes(&mut self, classes: &Classes) {
        let names: Vec<_> = classes.iter().collect();
        let mut sorted: Vec<_> = (0..names.len()).collect();
        sorted.sort_by_key(|class| names[*class]);
        self.order = vec![0; names.len()];
        sorted.iter().enumerate().for_each(|(place, class)| self.order[*class] = place);
        self.names.extend((0..).zip(names).map(|(class, name)| (class, Arc::from(name))));
    }

    fn update(&mut self, _at: usize, prediction: &Category, ground_truth: &Category) -> Result<f64> {
        let correct = prediction.class == ground_truth.class;
        let scores = &prediction.probabilities;
        let rank = match scores.is_empty() {
            true => None,
            false => Some(rank_of_class(ground_truth.class, scores, &self.order)?),
        };
        let own = usize::try_from(prediction.class).ok().and_then(|class| scores.get(class));
        if let Some(confidence) = prediction.confidence.or(own.copied()) {
            self.calibration.add(correct, f64::from(confidence))?;
        }
        if let Some(rank) = rank {
            self.add_rank(rank);
        }
        for category in [ground_truth, prediction] {
            if let Some(name) = &category.description {
                self.names.entry(category.class).or_insert_with(|| name.clone());
            }
        }
        self.add(ground_truth.class, prediction.class);
        Ok(f64::from(u8::from(correct)))
    }

    /// Accepts a list of boxes (recognised faces) as the class of its box with the highest score, and an empty one as class
    /// -1.
    fn prediction(value: ValueRef<'_>) -> Option<Cow<'_, Category>> {
        let ValueRef::BoundingBoxList(list) = value else {
            return Category::from_value_ref(value).map(Cow::Borrowed);
        };
        let best = list.boxes.iter().max_by(|one, other| one.confidence.total_cmp(&other.confidence));
        let Some(best) = best else { return Some(Cow::Owned(Category::new(-1, None))) };
        let class = match &best.name {
            Name::Index(class) => *class,
            Name::Label(label) => list.classes.index(label).unwrap_or(-1),
        };
        let description = list.label(best).map(Arc::from);
        Some(Cow::Owned(Category { description, ..Category::new(class, Some(best.confidence)) }))
    }

    fn merge(&mut self, other: Self) {
        for (label, name) in other.names {
            self.names.entry(label).or_insert(name);
        }
        for (pair, count) in other.pairs {
            *self.pairs.entry(pair).or_default() += count;
        }
        if self.ranks.len() < other.ranks.len() {
            self.ranks.resize(other.ranks.len(), 0);
        }
        self.ranks.iter_mut().zip(&other.ranks).for_each(|(mine, more)| *mine += more);
        self.calibration.merge(&other.calibration);
    }

    fn finish(&self) -> Report {
        let mut report = Report::new("accuracy");
        let mut set = |key: &str, value: Option<f64>| report.statistics.set(key, value.unwrap_or(f64::NAN));
        set("samples", Some(self.samples() as f64));
        set("accuracy", self.accuracy());
        set("balanced_accuracy", self.balanced_accuracy());
        set("expected_calibration_error", self.calibration.expected_error());
        set("maximum_calibration_error", self.calibration.maximum_error());
        for k in &self.params.top_k {
            set(&format!("top_{k}_accuracy"), self.top_k(*k));
        }
        let scores = self.scores();
        for (average, row) in
            [("micro", scores.micro), ("macro", scores.macro_), ("weighted", scores.weighted)]
        {
            set(&format!("precision_{average}"), row.precision);
            set(&format!("recall_{average}"), row.recall);
            set(&format!("f1_{average}"), row.f1);
        }
        report.tables.push(self.table(&scores));
        let labels = self.labels();
        if (1..=MATRIX_CLASSES).contains(&labels.len()) {
            report.figures.push(Figure::Matrix(Matrix {
                name: "confusion".to_owned(),
                title: "Confusion matrix".to_owned(),
                counts: self.confusion(&labels),
                labels: labels.into_iter().map(|label| self.name(label)).collect(),
            }));
        }
        report.figures.extend(self.calibration.figure());
        report
    }
}

/// Returns the number of classes that rank before class `ground_truth`; see [`Classification::add_scores`].
fn rank_of_class(ground_truth: i64, scores: &[f32], order: &[usize]) -> Result<usize> {
    let class = usize::try_from(ground_truth)
        .ok()
        .filter(|class| *class < scores.len() && scores.len() <= MAX_SCORES);
    let Some(class) = class else {
        let count = scores.len();
        return Err(Error::invalid_input(format!(
            "class {ground_truth} has none of {count} scores; give one score per class, at most {MAX_SCORES}"
        )));
    };
    if let Some(place) = scores.iter().position(|score| score.is_nan()) {
        return Err(Error::invalid_input(format!("score of class {place} is NaN; give numbers")));
    }
    let own = scores[class];
    // Classes without a name in the data set rank after those with one.
    let place = |class: usize| order.get(class).copied().unwrap_or(class);
    let before =
        |(other, score): &(usize, &f32)| **score > own || (**score == own && place(*other) > place(class));
    Ok(scores.iter().enumerate().filter(before).count())
}

#[cfg(test)]
mod tests;
