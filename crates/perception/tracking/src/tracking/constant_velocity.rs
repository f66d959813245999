//! Kalman filters of one coordinate.
//!
//! R. E. Kalman, "A New Approach to Linear Filtering and Prediction Problems", 1960. The filters of SORT, DeepSORT and
//! AB3DMOT have up to ten state variables, but their matrices couple a coordinate with its own velocity only. They
//! therefore separate into filters of two variables and of one, which have the same results up to rounding without
//! matrices.

/// One coordinate with constant velocity, per frame, and their covariance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ConstantVelocity {
    /// Position.
    pub position: f64,
    /// Change of the position per frame.
    pub velocity: f64,
    /// Variance of the position, covariance of both, variance of the velocity.
    covariance: [f64; 3],
}

impl ConstantVelocity {
    /// Creates a filter at `position`, at rest, with `variances` of position and velocity.
    pub const fn new(position: f64, variances: [f64; 2]) -> Self {
        Self { position, velocity: 0.0, covariance: [variances[0], 0.0, variances[1]] }
    }

    /// Advances by one frame; `noise` is added to the variances of position and velocity.
    pub fn predict(&mut self, noise: [f64; 2]) {
        let [position, both, velocity] = self.covariance;
        self.position += self.velocity;
        self.covariance = [position + 2.0 * both + velocity + noise[0], both + velocity, velocity + noise[1]];
    }

    /// Updates with the measurement `measured` of variance `noise`.
    pub fn update(&mut self, measured: f64, noise: f64) {
        let [position, both, velocity] = self.covariance;
        let spread = position + noise;
        if spread > 0.0 {
            let innovation = measured - self.position;
            self.position += position / spread * innovation;
            self.velocity += both / spread * innovation;
            let kept = noise / spread;
            self.covariance = [position * kept, both * kept, velocity - both * both / spread];
        }
    }

    /// Returns the squared Mahalanobis distance of `measured` from the position.
    pub fn squared_distance(&self, measured: f64, noise: f64) -> f64 {
        (measured - self.position).powi(2) / (self.covariance[0] + noise)
    }

    /// Rescales position, velocity and variances by `scale`.
    pub(super) fn rescale(&mut self, scale: f64) {
        self.position *= scale;
        self.velocity *= scale;
        self.covariance = self.covariance.map(|variance| variance * scale * scale);
    }
}

/// One constant number with its variance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Constant {
    /// The number.
    pub value: f64,
    variance: f64,
}

impl Constant {
    /// Creates a number with a variance.
    pub const fn new(value: f64, variance: f64) -> Self {
        Self { value, variance }
    }

    /// Advances by one frame; `noise` is added to the variance.
    pub fn predict(&mut self, noise: f64) {
        self.variance += noise;
    }

    /// Updates with a measurement of variance `noise`.
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
