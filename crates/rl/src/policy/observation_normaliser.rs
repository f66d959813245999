//! Normalisation of observations to mean 0 and variance 1; the statistics are part of the policy.

use opendr_simulation::wrappers::RunningMoments;

/// Normalises numbers by the running mean and variance of the training, as Stable-Baselines3's `VecNormalize` does for
/// observations.
#[derive(Debug, Clone, PartialEq)]
pub struct ObservationNormaliser {
    /// Running statistics.
    pub moments: RunningMoments,
    /// Normalised numbers are clipped to plus and minus this value.
    pub clip: f32,
}

/// Added to the variance, against a division by zero.
pub(crate) const EPSILON: f64 = 1e-8;

impl ObservationNormaliser {
    pub(crate) fn new(size: usize, clip: f32) -> Self {
        Self { moments: RunningMoments::new(size), clip }
    }

    /// Normalises numbers in place; `first` is the index of the first among the statistics.
    pub(crate) fn normalise(&self, first: usize, numbers: &mut [f32]) {
        let (mean, variance) = (&self.moments.mean()[first..], &self.moments.variance()[first..]);
        let clip = f64::from(self.clip);
        for (number, (mean, variance)) in numbers.iter_mut().zip(mean.iter().zip(variance)) {
            let normalised = (f64::from(*number) - mean) / (variance + EPSILON).sqrt();
            *number = normalised.clamp(-clip, clip) as f32;
        }
    }
}
