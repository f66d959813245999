//! SORT's Kalman filter of a box.

use super::camera_motion::SimilarityMotion;
use super::{Constant, ConstantVelocity, corners, middle_and_size};

/// Kalman filter of centre and area of a box, each with its velocity, and its constant aspect ratio (A. Bewley et al.,
/// "Simple Online and Realtime Tracking", ICIP 2016). Positions are in pixels, variances are OC-SORT's.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AreaFilter {
    x: ConstantVelocity,
    y: ConstantVelocity,
    area: ConstantVelocity,
    ratio: Constant,
}

/// Variances of a state with unknown velocities, of the process and of measurements.
const START: [f64; 2] = [10.0, 1e4];
const MOTION: [f64; 2] = [1.0, 0.01];
const GROWTH: [f64; 2] = [1.0, 1e-4];
const MEASURED: f64 = 1.0;
const MEASURED_SHAPE: f64 = 10.0;

impl AreaFilter {
    /// Creates a filter for the first observation `[x0, y0, x1, y1]` of a box.
    pub fn new(observed: [f64; 4]) -> Self {
        let [x, y, width, height] = middle_and_size(observed);
        let [x, y, area] = [x, y, width * height].map(|value| ConstantVelocity::new(value, START));
        Self { x, y, area, ratio: Constant::new(width / height, START[0]) }
    }

    /// Advances by one frame.
    pub fn predict(&mut self) {
        // The area stays positive.
        if self.area.position + self.area.velocity <= 0.0 {
            self.area.velocity = 0.0;
        }
        self.x.predict(MOTION);
        self.y.predict(MOTION);
        self.area.predict(GROWTH);
        self.ratio.predict(MOTION[0]);
    }

    /// Updates with an observation.
    pub fn update(&mut self, observed: [f64; 4]) {
        let [x, y, width, height] = middle_and_size(observed);
        self.x.update(x, MEASURED);
        self.y.update(y, MEASURED);
        self.area.update(width * height, MEASURED_SHAPE);
        self.ratio.update(width / height, MEASURED_SHAPE);
    }

    /// Returns the box `[x0, y0, x1, y1]`.
    pub fn corners(&self) -> [f64; 4] {
        let (area, ratio) = (self.area.position.max(0.0), self.ratio.value.max(0.0));
        let width = (area * ratio).sqrt();
        let height = if width > 0.0 { area / width } else { 0.0 };
        corners([self.x.position, self.y.position, width, height])
    }

    /// Compensates a motion of the camera. Its rotations are small: they change positions and velocities, not variances.
    pub fn move_camera(&mut self, motion: &SimilarityMotion) {
        let [x, y] = motion.map([self.x.position, self.y.position]);
        let [across, down] = motion.map_direction([self.x.velocity, self.y.velocity]);
        (self.x.position, self.x.velocity) = (x, across);
        (self.y.position, self.y.velocity) = (y, down);
        self.area.rescale(motion.scale().powi(2));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn follows_a_box_that_moves_and_grows() {
        let at = |frame: f64| {
            let side = 40.0 + frame;
            corners([100.0 + 3.0 * frame, 50.0 - 2.0 * frame, side, 2.0 * side])
        };
        let mut filter = AreaFilter::new(at(0.0));
        for frame in 1..20 {
            filter.predict();
            filter.update(at(f64::from(frame)));
        }
        filter.predict();
        let (found, expected) = (filter.corners(), at(20.0));
        assert!(
            found.iter().zip(expected).all(|(found, expected)| (found - expected).abs() < 1.5),
            "{found:?} {expected:?}"
        );
    }

    #[test]
    fn never_shrinks_to_nothing() {
        let mut filter = AreaFilter::new([0.0, 0.0, 100.0, 100.0]);
        for frame in 1..8 {
            filter.predict();
            let side = 100.0 / f64::from(1 << frame);
            filter.update([0.0, 0.0, side, side]);
        }
        for _ in 0..100 {
            filter.predict();
            let [x0, y0, x1, y1] = filter.corners();
            assert!(x1 >= x0 && y1 >= y0 && (x1 - x0).is_finite());
        }
    }

    #[test]
    fn moves_with_the_camera() {
        let mut filter = AreaFilter::new([10.0, 10.0, 30.0, 50.0]);
        filter.move_camera(&SimilarityMotion::new([2.0, 0.0], [5.0, -5.0]));
        let found = filter.corners();
        let expected = [25.0, 15.0, 65.0, 95.0];
        assert!(
            found.iter().zip(expected).all(|(found, expected)| (found - expected).abs() < 1e-9),
            "{found:?}"
        );
    }
}
