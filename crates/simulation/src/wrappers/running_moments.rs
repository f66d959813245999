//! Running mean and variance.

use opendr_engine::environment::{Snapshot, StateReader};
use opendr_engine::{Error, Result};

/// Running mean and variance of each of several numbers (Chan, Golub and LeVeque, 1979), as Gymnasium's
/// `RunningMeanStd`: starts with mean 0, variance 1 and the weight of 1e-4 samples.
#[derive(Debug, Clone, PartialEq)]
pub struct RunningMoments {
    mean: Vec<f64>,
    variance: Vec<f64>,
    count: f64,
}

impl RunningMoments {
    /// Creates the moments of `size` numbers.
    pub fn new(size: usize) -> Self {
        Self { mean: vec![0.0; size], variance: vec![1.0; size], count: 1e-4 }
    }

    /// Restores moments from the values of [`Self::mean`], [`Self::variance`] and [`Self::count`].
    ///
    /// # Errors
    /// `Format` when the lengths differ, a number is not finite, or a variance or the count is negative.
    pub fn from_parts(mean: Vec<f64>, variance: Vec<f64>, count: f64) -> Result<Self> {
        let is_sound = |number: &f64| number.is_finite() && *number >= 0.0;
        let sound =
            mean.iter().all(|mean| mean.is_finite()) && variance.iter().all(is_sound) && is_sound(&count);
        if mean.len() == variance.len() && sound {
            return Ok(Self { mean, variance, count });
        }
        Err(Error::format(format!(
            "{} means and {} variances of {count} samples; they must have equal length, be finite, and no variance be negative",
            mean.len(),
            variance.len()
        )))
    }

    /// Adds one sample.
    pub fn add(&mut self, sample: impl IntoIterator<Item = f64>) {
        let total = self.count + 1.0;
        for ((mean, variance), number) in self.mean.iter_mut().zip(&mut self.variance).zip(sample) {
            let delta = number - *mean;
            *mean += delta / total;
            *variance = (*variance * self.count + delta * delta * self.count / total) / total;
        }
        self.count = total;
    }

    /// Merges the samples of another; the result does not depend on how samples were divided.
    pub fn merge(&mut self, other: &Self) {
        let total = self.count + other.count;
        let own = self.mean.iter_mut().zip(&mut self.variance);
        for ((mean, variance), (other_mean, other_variance)) in
            own.zip(other.mean.iter().zip(&other.variance))
        {
            let delta = other_mean - *mean;
            let both = *variance * self.count + other_variance * other.count;
            *mean += delta * other.count / total;
            *variance = (both + delta * delta * self.count * other.count / total) / total;
        }
        self.count = total;
    }

    /// Returns the means.
    pub fn mean(&self) -> &[f64] {
        &self.mean
    }

    /// Returns the variances.
    pub fn variance(&self) -> &[f64] {
        &self.variance
    }

    /// Returns the number of samples, plus 1e-4.
    pub fn count(&self) -> f64 {
        self.count
    }

    /// Normalises numbers in place to mean 0 and variance 1.
    pub fn normalise(&self, numbers: &mut [f32]) {
        for (number, (mean, variance)) in numbers.iter_mut().zip(self.mean.iter().zip(&self.variance)) {
            *number = ((f64::from(*number) - mean) / (variance + EPSILON).sqrt()) as f32;
        }
    }

    /// Writes the moments into a snapshot.
    pub fn save(&self, snapshot: &mut Snapshot) {
        snapshot.extend_numbers(self.mean.iter().chain(&self.variance).copied().chain([self.count]));
    }

    /// Reads what [`Self::save`] wrote, for the same size.
    ///
    /// # Errors
    /// `Format` at the end of the snapshot and for numbers that are not finite.
    pub fn load(&mut self, state: &mut StateReader<'_>) -> Result<()> {
        for number in self.mean.iter_mut().chain(&mut self.variance).chain([&mut self.count]) {
            *number = state.finite()?;
        }
        Ok(())
    }
}

/// Added to the variance, against a division by zero.
pub(super) const EPSILON: f64 = 1e-8;
