//! DeepSORT's Kalman filter of a box.

use super::camera_motion::SimilarityMotion;
use super::{ConstantVelocity, corners, middle_and_size};

/// Kalman filter of centre, aspect ratio and height of a box, each with its velocity (N. Wojke et al., "Simple Online and
/// Realtime Tracking with a Deep Association Metric", ICIP 2017). Standard deviations are relative to the height: near
/// objects move more pixels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HeightFilter {
    x: ConstantVelocity,
    y: ConstantVelocity,
    ratio: ConstantVelocity,
    height: ConstantVelocity,
}

/// Standard deviations relative to the height: of a position, and of a velocity.
const POSITION: f64 = 1.0 / 20.0;
const VELOCITY: f64 = 1.0 / 160.0;
/// Standard deviations of the aspect ratio, of its velocity, and of its measurement.
const RATIO: f64 = 1e-2;
const RATIO_VELOCITY: f64 = 1e-5;
const MEASURED_RATIO: f64 = 1e-1;

impl HeightFilter {
    /// 95 % quantile of the chi-squared distribution with four degrees of freedom: the gate of
    /// [`HeightFilter::squared_distance`].
    pub const GATE: f64 = 9.4877;

    /// Creates a filter for the first observation `[x0, y0, x1, y1]` of a box.
    pub fn new(observed: [f64; 4]) -> Self {
        let [x, y, width, height] = middle_and_size(observed);
        let moving = [(2.0 * POSITION * height).powi(2), (10.0 * VELOCITY * height).powi(2)];
        let [x, y, height_of] = [x, y, height].map(|value| ConstantVelocity::new(value, moving));
        let shape = [RATIO * RATIO, RATIO_VELOCITY * RATIO_VELOCITY];
        Self { x, y, ratio: ConstantVelocity::new(width / height, shape), height: height_of }
    }

    /// Advances by one frame.
    pub fn predict(&mut self) {
        let height = self.height.position;
        let noise = [(POSITION * height).powi(2), (VELOCITY * height).powi(2)];
        self.x.predict(noise);
        self.y.predict(noise);
        self.ratio.predict([RATIO * RATIO, RATIO_VELOCITY * RATIO_VELOCITY]);
        self.height.predict(noise);
    }

    /// Updates with an observation.
    pub fn update(&mut self, observed: [f64; 4]) {
        let [x, y, width, height] = middle_and_size(observed);
        let noise = self.measured();
        self.x.update(x, noise);
        self.y.update(y, noise);
        self.ratio.update(width / height, MEASURED_RATIO * MEASURED_RATIO);
        self.height.update(height, noise);
    }

    /// Returns the squared Mahalanobis distance of `observed` from the prediction.
    pub fn squared_distance(&self, observed: [f64; 4]) -> f64 {
        let [x, y, width, height] = middle_and_size(observed);
        let noise = self.measured();
        self.x.squared_distance(x, noise)
            + self.y.squared_distance(y, noise)
            + self.ratio.squared_distance(width / height, MEASURED_RATIO * MEASURED_RATIO)
            + self.height.squared_distance(height, noise)
    }

    fn measured(&self) -> f64 {
        (POSITION * self.height.position).powi(2)
    }

    /// Sets the velocity of the height to 0, for objects without a detection.
    pub fn stop_growing(&mut self) {
        self.height.velocity = 0.0;
    }

    /// Returns the box `[x0, y0, x1, y1]`.
    pub fn corners(&self) -> [f64; 4] {
        let height = self.height.position.max(0.0);
        corners([self.x.position, self.y.position, (self.ratio.position * height).max(0.0), height])
    }

    /// Compensates a motion of the camera. Its rotations are small: they change positions and velocities, not variances.
    pub fn move_camera(&mut self, motion: &SimilarityMotion) {
        let [x, y] = motion.map([self.x.position, self.y.position]);
        let [across, down] = motion.map_direction([self.x.velocity, self.y.velocity]);
        (self.x.position, self.x.velocity) = (x, across);
        (self.y.position, self.y.velocity) = (y, down);
        self.height.rescale(motion.scale());
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn follows_a_box_that_moves() {
        let at = |frame: f64| corners([100.0 + 3.0 * frame, 50.0 - 2.0 * frame, 40.0, 80.0]);
        let mut filter = HeightFilter::new(at(0.0));
        for frame in 1..30 {
            filter.predict();
            filter.update(at(f64::from(frame)));
        }
        filter.predict();
        let (found, expected) = (filter.corners(), at(30.0));
        assert!(
            found.iter().zip(expected).all(|(found, expected)| (found - expected).abs() < 0.5),
            "{found:?} {expected:?}"
        );
        assert!(filter.squared_distance(expected) < 0.1);
        assert!(filter.squared_distance(at(40.0)) > HeightFilter::GATE);
    }

    #[test]
    fn moves_with_the_camera() {
        let mut filter = HeightFilter::new([10.0, 10.0, 30.0, 50.0]);
        filter.move_camera(&SimilarityMotion::new([2.0, 0.0], [5.0, -5.0]));
        let found = filter.corners();
        let expected = [25.0, 15.0, 65.0, 95.0];
        assert!(
            found.iter().zip(expected).all(|(found, expected)| (found - expected).abs() < 1e-9),
            "{found:?}"
        );
    }
}
