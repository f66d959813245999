//! Kalman filters of one coordinate.
//!
//! R. E. Kalman, "A New Approach to Linear Filtering and Prediction Problems", 1960. The filters of SORT, DeepSORT and
//! AB3DMOT have up to ten numbers, but every matrix of theirs couples a coordinate with its own velocity only. So they
//! fall apart into filters of two numbers and of one, which give the same answers to the last digits without a matrix.

/// One coordinate that moves at a constant velocity, per frame, and the variances of both.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ConstantVelocity {
    /// Where it is.
    pub position: f64,
    /// By how much it changes from frame to frame.
    pub velocity: f64,
    /// Variance of the position, covariance of both, variance of the velocity.
    covariance: [f64; 3],
}

impl ConstantVelocity {
    /// At `position`, at rest as far as one knows; `variances` of position and velocity.
    pub const fn new(position: f64, variances: [f64; 2]) -> Self {
        Self { position, velocity: 0.0, covariance: [variances[0], 0.0, variances[1]] }
    }

    /// One frame on; `noise` is what is added to the variances of position and velocity.
    pub fn predict(&mut self, noise: [f64; 2]) {
        let [position, both, velocity] = self.covariance;
        self.position += self.velocity;
        self.covariance = [position + 2.0 * both + velocity + noise[0], both + velocity, velocity + noise[1]];
    }

    /// Takes in that it was measured at `measured`, with the variance `noise`.
    pub fn update(&mut self, measured: f64, noise: f64) {
        let [position, both, velocity] = self.covariance;
        let spread = position + noise;
        if spread > 0.0 {
            let surprise = measured - self.position;
            self.position += position / spread * surprise;
            self.velocity += both / spread * surprise;
            let kept = noise / spread;
            self.covariance = [position * kept, both * kept, velocity - both * both / spread];
        }
    }

    /// The squared distance of `measured` from where it is expected, in standard deviations (Mahalanobis).
    pub fn squared_distance(&self, measured: f64, noise: f64) -> f64 {
        (measured - self.position).powi(2) / (self.covariance[0] + noise)
    }

    /// Everything in units of which the old one is `scale`.
    pub(super) fn rescale(&mut self, scale: f64) {
        self.position *= scale;
        self.velocity *= scale;
        self.covariance = self.covariance.map(|variance| variance * scale * scale);
    }
}

/// One number that stays as it is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Constant {
    /// The number.
    pub value: f64,
    variance: f64,
}

impl Constant {
    /// A number known with this variance.
    pub const fn new(value: f64, variance: f64) -> Self {
        Self { value, variance }
    }

    /// One frame on; `noise` is added to the variance.
    pub fn predict(&mut self, noise: f64) {
        self.variance += noise;
    }

    /// Takes in a measurement with the variance `noise`.
    pub fn update(&mut self, measured: f64, noise: f64) {
        let spread = self.variance + noise;
        if spread > 0.0 {
            self.value += self.variance / spread * (measured - self.value);
            self.variance *= noise / spread;
        }
    }
}

#[cfg(test)]
mod tests;
