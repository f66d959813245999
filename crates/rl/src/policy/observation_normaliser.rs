//! Observations of mean 0 and variance 1, with what was seen kept in the policy.

use opendr_simulation::wrappers::RunningMoments;

/// Normalises numbers by the mean and variance of all that training saw (the observations of Stable-Baselines3's
/// `VecNormalize`).
#[derive(Debug, Clone, PartialEq)]
pub struct ObservationNormaliser {
    /// What was seen.
    pub moments: RunningMoments,
    /// Normalised numbers lie within plus and minus this.
    pub clip: f32,
}

/// What keeps a division from zero.
pub(crate) const EPSILON: f64 = 1e-8;

impl ObservationNormaliser {
    pub(crate) fn new(size: usize, clip: f32) -> Self {
        Self { moments: RunningMoments::new(size), clip }
    }

    /// Normalises, in place, the numbers from `first` on.
    pub(crate) fn normalise(&self, first: usize, numbers: &mut [f32]) {
        let (mean, variance) = (&self.moments.mean()[first..], &self.moments.variance()[first..]);
        let clip = f64::from(self.clip);
        for (number, (mean, variance)) in numbers.iter_mut().zip(mean.iter().zip(variance)) {
            let normalised = (f64::from(*number) - mean) / (variance + EPSILON).sqrt();
            *number = normalised.clamp(-clip, clip) as f32;
        }
    }
}
