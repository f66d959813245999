//! Regression of numbers: mean errors and R² equal to scikit-learn, and the concordance correlation coefficient (Lin,
//! 1989), the measure for valence and arousal.

use std::borrow::Cow;

use opendr_engine::data::Vector;
use opendr_engine::params::NoParams;
use opendr_engine::target::HeatmapValues;
use opendr_engine::{Error, Result, ValueRef};

use crate::average::mean;
use crate::{Metric, Report, Table};

/// Errors of one number over all samples: means and sums of squares that can be merged (Chan et al., 1979).
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Residuals {
    count: u64,
    absolute: f64,
    squared: f64,
    truth_mean: f64,
    predicted_mean: f64,
    truth_squares: f64,
    predicted_squares: f64,
    products: f64,
}

impl Residuals {
    /// Adds a sample; both numbers are finite.
    pub fn add(&mut self, ground_truth: f64, predicted: f64) {
        let error = predicted - ground_truth;
        let (absolute, squared) = (error.abs(), error * error);
        let (truth_mean, predicted_mean) = (ground_truth, predicted);
        self.merge(&Self { count: 1, absolute, squared, truth_mean, predicted_mean, ..Self::default() });
    }

    /// Adds the samples of another accumulator.
    pub fn merge(&mut self, other: &Self) {
        let total = self.count + other.count;
        if total == 0 {
            return;
        }
        let share = other.count as f64 / total as f64;
        let weight = self.count as f64 * share;
        let ground_truth = other.truth_mean - self.truth_mean;
        let predicted = other.predicted_mean - self.predicted_mean;
        self.truth_squares += other.truth_squares + ground_truth * ground_truth * weight;
        self.predicted_squares += other.predicted_squares + predicted * predicted * weight;
        self.products += other.products + ground_truth * predicted * weight;
        self.truth_mean += ground_truth * share;
        self.predicted_mean += predicted * share;
        self.absolute += other.absolute;
        self.squared += other.squared;
        self.count = total;
    }

    /// Returns the number of samples.
    pub fn count(&self) -> u64 {
        self.count
    }

    /// Returns the mean absolute error.
    pub fn mean_absolute_error(&self) -> Option<f64> {
        (self.count > 0).then(|| self.absolute / self.count as f64)
    }

    /// Returns the root mean square error.
    pub fn root_mean_squared_error(&self) -> Option<f64> {
        (self.count > 0).then(|| (self.squared / self.count as f64).sqrt())
    }

    /// Returns the coefficient of determination, at most 1. For constant ground truth it is 1 if every prediction is exact,
    /// otherwise 0. `None` for fewer than two samples.
    pub fn r2(&self) -> Option<f64> {
        match self.truth_squares > 0.0 {
            _ if self.count < 2 => None,
            true => Some(1.0 - self.squared / self.truth_squares),
            false => Some(if self.squared > 0.0 { 0.0 } else { 1.0 }),
        }
    }

    /// Returns the concordance correlation coefficient, -1..=1, with population variances; `None` if ground truth and
    /// predictions are the same constant.
    pub fn concordance(&self) -> Option<f64> {
        let apart = self.truth_mean - self.predicted_mean;
        let spread = self.truth_squares + self.predicted_squares + self.count as f64 * apart * apart;
        (spread > 0.0).then(|| 2.0 * self.products / spread)
    }

    /// Returns Pearson's correlation coefficient, -1..=1; `None` if ground truth or predictions are constant.
    pub fn correlation(&self) -> Option<f64> {
        let spread = self.truth_squares.sqrt() * self.predicted_squares.sqrt();
        (spread > 0.0).then(|| (self.products / spread).clamp(-1.0, 1.0))
    }
}

/// [`Residuals`] of each element of a vector.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Regression {
    columns: Vec<Residuals>,
}

impl Regression {
    /// Returns the residuals of each element, in order.
    pub fn columns(&self) -> &[Residuals] {
        &self.columns
    }
}

type Measure = fn(&Residuals) -> Option<f64>;

/// Reported measures by key.
const MEASURES: [(&str, Measure); 5] = [
    ("mae", Residuals::mean_absolute_error),
    ("rmse", Residuals::root_mean_squared_error),
    ("r2", Residuals::r2),
    ("ccc", Residuals::concordance),
    ("correlation", Residuals::correlation),
];

/// Predictions and ground truth are vectors, or maps of scores. The report has the mean of each measure over the elements
/// of the vector (scikit-learn's `uniform_average`), and a row per element.
impl Metric for Regression {
    const NAME: &'static str = "regression";
    const ABOUT: &'static str = "MAE, RMSE and R2 as scikit-learn, concordance correlation coefficient";
    const NUMBERS: &'static [(&'static str, &'static str)] = &[
        ("ccc", "Concordance correlation coefficient."),
        ("correlation", "Pearson's correlation coefficient."),
        ("r2", "Coefficient of determination."),
        ("mae", "Mean absolute error."),
        ("rmse", "Root mean square error."),
        ("samples", "Number of samples."),
    ];
    const LOWER_IS_BETTER: &'static [&'static str] = &["mae", "rmse"];
    type Params = NoParams;
    type Prediction = Vector;
    type GroundTruth = Vector;

    fn new(_params: &NoParams) -> Result<Self> {
        Ok(Self::default())
    }

    fn update(&mut self, _at: usize, prediction: &Vector, ground_truth: &Vector) -> Result<f64> {
        let (given, ground_truth) = (prediction.as_slice(), ground_truth.as_slice());
        let expected = if self.columns.is_empty() { ground_truth.len() } else { self.columns.len() };
        if given.len() != ground_truth.len() || ground_truth.len() != expected {
            let (given, ground_truth) = (given.len(), ground_truth.len());
            return Err(Error::invalid_input(format!(
                "{given} predicted and {ground_truth} true numbers where {expected} are expected; give equally many in every sample"
            )));
        }
        if let Some(number) = given.iter().chain(ground_truth).find(|number| !number.is_finite()) {
            return Err(Error::invalid_input(format!("{number} is not finite; give finite numbers")));
        }
        self.columns.resize(expected, Residuals::default());
        let pairs = given
            .iter()
            .zip(ground_truth)
            .map(|(given, ground_truth)| [f64::from(*given), f64::from(*ground_truth)]);
        for (column, [given, ground_truth]) in self.columns.iter_mut().zip(pairs.clone()) {
            column.add(ground_truth, given);
        }
        let error = mean(pairs.map(|[given, ground_truth]| (given - ground_truth).abs()));
        Ok(1.0 / (1.0 + error.unwrap_or(0.0)))
    }

    fn merge(&mut self, other: Self) {
        if self.columns.len() < other.columns.len() {
            self.columns.resize(other.columns.len(), Residuals::default());
        }
        self.columns.iter_mut().zip(&other.columns).for_each(|(mine, more)| mine.merge(more));
    }

    fn finish(&self) -> Report {
        let mut report = Report::new("ccc");
        let samples = self.columns.first().map_or(0, Residuals::count);
        report.statistics.set("samples", samples as f64);
        for (key, number) in MEASURES {
            let average = mean(self.columns.iter().filter_map(number));
            report.statistics.set(key, average.unwrap_or(f64::NAN));
        }
        let row = |(at, column): (usize, &Residuals)| {
            (at.to_string(), MEASURES.map(|(_, number)| number(column)).to_vec())
        };
        report.tables.push(Table {
            name: "number".to_owned(),
            columns: MEASURES.map(|(key, _)| key.to_owned()).to_vec(),
            rows: self.columns.iter().enumerate().map(row).collect(),
        });
        report
    }

    fn prediction(value: ValueRef<'_>) -> Option<Cow<'_, Vector>> {
        match value {
            ValueRef::Vector(vector) => Some(Cow::Borrowed(vector)),
            ValueRef::Heatmap(map) => match map.values() {
                HeatmapValues::Scores(scores) => Vector::from_data(scores.clone()).ok().map(Cow::Owned),
                HeatmapValues::Labels(_) => None,
            },
            _ => None,
        }
    }

    fn ground_truth(value: ValueRef<'_>) -> Option<Cow<'_, Vector>> {
        Self::prediction(value)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn counted(pairs: &[(f64, f64)]) -> Residuals {
        let mut residuals = Residuals::default();
        pairs.iter().for_each(|(ground_truth, predicted)| residuals.add(*ground_truth, *predicted));
        residuals
    }

    #[test]
    fn example_of_scikit_learn() {
        let residuals = counted(&[(3.0, 2.5), (-0.5, 0.0), (2.0, 2.0), (7.0, 8.0)]);
        assert_eq!(residuals.mean_absolute_error(), Some(0.5));
        assert!((residuals.root_mean_squared_error().unwrap() - 0.375_f64.sqrt()).abs() < 1e-12);
        assert!((residuals.r2().unwrap() - 0.9486081370449679).abs() < 1e-12);
        assert!((residuals.concordance().unwrap() - 0.97678916827853).abs() < 1e-12);
    }

    #[test]
    fn constants() {
        assert_eq!(counted(&[(-2.0, -2.0), (-2.0, -2.0)]).r2(), Some(1.0));
        assert_eq!(counted(&[(-2.0, -2.0), (-2.0, -1.0)]).r2(), Some(0.0));
        assert_eq!(counted(&[(-2.0, -2.0)]).r2(), None);
        assert_eq!(counted(&[(1.0, 1.0), (1.0, 1.0)]).concordance(), None);
        assert_eq!(counted(&[(1.0, 2.0), (1.0, 2.0)]).concordance(), Some(0.0));
        assert_eq!(counted(&[(1.0, 2.0), (1.0, 2.0)]).correlation(), None);
        assert_eq!(Residuals::default().mean_absolute_error(), None);
    }

    #[test]
    fn far_from_zero() {
        // Plain sums of squares would lose every digit here.
        let residuals = counted(&[(1e9, 1e9), (1e9 + 1.0, 1e9 + 1.0), (1e9 + 2.0, 1e9 + 2.0)]);
        assert_eq!((residuals.r2(), residuals.concordance()), (Some(1.0), Some(1.0)));
    }

    #[test]
    fn parts_merge_to_the_whole() {
        let pairs = [(3.0, 2.5), (-0.5, 0.0), (2.0, 2.0), (7.0, 8.0)];
        let mut merged = counted(&pairs[2..]);
        merged.merge(&counted(&pairs[..2]));
        merged.merge(&Residuals::default());
        let whole = counted(&pairs);
        for (_, number) in MEASURES {
            assert!((number(&merged).unwrap() - number(&whole).unwrap()).abs() < 1e-12);
        }
    }

    #[test]
    fn invalid_vectors_are_rejected() {
        let vector = |numbers: &[f32]| Vector::from_data(numbers.to_vec()).unwrap();
        let mut regression = Regression::default();
        assert!(regression.update(0, &vector(&[1.0]), &vector(&[1.0, 2.0])).is_err());
        assert!(regression.update(0, &vector(&[f32::NAN]), &vector(&[1.0])).is_err());
        assert_eq!(regression, Regression::default());
        assert_eq!(regression.update(0, &vector(&[1.0, 2.0]), &vector(&[0.0, 1.0])).unwrap(), 0.5);
        assert!(regression.update(1, &vector(&[1.0]), &vector(&[1.0])).is_err());
    }
}
