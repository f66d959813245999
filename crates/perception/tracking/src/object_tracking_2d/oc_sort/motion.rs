//! The motion of one object of OC-SORT, with its observations.

use std::f64::consts::{FRAC_PI_2, PI};

use crate::tracking::AreaFilter;
use crate::tracking::camera_motion::SimilarityMotion;

/// Maximum number of frames over which directions are measured.
pub(super) const MOST_FRAMES_BACK: usize = 10;
const SLOTS: usize = MOST_FRAMES_BACK + 1;

pub(super) struct Motion {
    filter: AreaFilter,
    /// The filter at the last observation.
    filter_when_seen: AreaFilter,
    /// Predicted box in this frame.
    pub expected: [f64; 4],
    /// Last observation.
    pub last: [f64; 4],
    /// Observations of the last frames, by frame index modulo their number.
    observed: [Option<[f64; 4]>; SLOTS],
    age: usize,
    /// Direction of motion, of length 1; `None` before the second observation.
    direction: Option<[f64; 2]>,
}

impl Motion {
    pub fn new(observed: [f64; 4]) -> Self {
        let filter = AreaFilter::new(observed);
        let mut slots = [None; SLOTS];
        slots[0] = Some(observed);
        Self {
            filter,
            filter_when_seen: filter,
            expected: observed,
            last: observed,
            observed: slots,
            age: 0,
            direction: None,
        }
    }

    /// Advances by one frame in which the camera moved by `camera`.
    pub fn predict(&mut self, _: u32, camera: Option<&SimilarityMotion>) {
        if let Some(camera) = camera {
            self.move_camera(camera);
        }
        self.filter.predict();
        self.expected = self.filter.corners();
        self.age = self.age.wrapping_add(1);
        self.observed[self.age % SLOTS] = None;
    }

    /// Updates with the observation of this frame, `frames` frames after the last one; directions are measured over `span` frames.
    pub fn update(&mut self, observed: [f64; 4], span: usize, frames: u32) {
        let before = self.observed_before(span);
        self.direction = direction(before, observed).or(self.direction);
        if frames > 1 {
            // Observation-centric re-update along the straight line from the last observation.
            self.filter = self.filter_when_seen;
            for frame in 1..=frames {
                let share = f64::from(frame) / f64::from(frames);
                let between = |at: usize| self.last[at] + share * (observed[at] - self.last[at]);
                self.filter.predict();
                self.filter.update(std::array::from_fn(between));
            }
        } else {
            self.filter.update(observed);
        }
        self.filter_when_seen = self.filter;
        self.last = observed;
        self.observed[self.age % SLOTS] = Some(observed);
    }

    /// Returns the agreement of the direction to `found` with the direction of motion: 0.5 for the same, -0.5 for the opposite,
    /// 0 without a direction.
    pub fn agreement(&self, found: [f64; 4], span: usize) -> f64 {
        let way = direction(self.observed_before(span), found);
        let cosine = self.direction.zip(way).map(|([x, y], [u, v])| (x * u + y * v).clamp(-1.0, 1.0));
        cosine.map_or(0.0, |cosine| (FRAC_PI_2 - cosine.acos()) / PI)
    }

    /// Returns the observation `span` frames ago, or the first one after that.
    fn observed_before(&self, span: usize) -> [f64; 4] {
        let slot = |back: usize| self.observed[self.age.wrapping_sub(back) % SLOTS];
        (1..=span.min(self.age)).rev().find_map(slot).unwrap_or(self.last)
    }

    /// Compensates a motion of the camera.
    fn move_camera(&mut self, motion: &SimilarityMotion) {
        self.filter.move_camera(motion);
        self.filter_when_seen.move_camera(motion);
        self.last = motion.map_box(self.last);
        self.observed.iter_mut().flatten().for_each(|observed| *observed = motion.map_box(*observed));
        self.direction = self.direction.and_then(|direction| unit(motion.map_direction(direction)));
    }
}

/// Returns the direction from the centre of one box to that of another.
fn direction(from: [f64; 4], to: [f64; 4]) -> Option<[f64; 2]> {
    unit([to[0] + to[2] - from[0] - from[2], to[1] + to[3] - from[1] - from[3]])
}

fn unit([x, y]: [f64; 2]) -> Option<[f64; 2]> {
    let length = x.hypot(y);
    (length > 0.0 && length.is_finite()).then(|| [x / length, y / length])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(x: f64, y: f64) -> [f64; 4] {
        [x, y, x + 20.0, y + 40.0]
    }

    #[test]
    fn directions_agree_or_do_not() {
        let mut motion = Motion::new(at(0.0, 0.0));
        assert_eq!(motion.agreement([5.0, 0.0, 25.0, 40.0], 3), 0.0);
        for frame in 1..5 {
            motion.predict(0, None);
            motion.update(at(10.0 * f64::from(frame), 0.0), 3, 1);
        }
        motion.predict(0, None);
        assert!((motion.agreement(at(50.0, 0.0), 3) - 0.5).abs() < 1e-9);
        assert!((motion.agreement(at(-50.0, 0.0), 3) + 0.5).abs() < 1e-9);
        // Three frames ago it was at 20.
        assert!(motion.agreement(at(20.0, 90.0), 3).abs() < 1e-9);
    }

    /// After a gap the filter equals that of an object with observations on the straight line.
    #[test]
    fn gaps_are_updated_along_a_straight_line() {
        let mut hidden = Motion::new(at(0.0, 0.0));
        let mut seen = Motion::new(at(0.0, 0.0));
        let mut away = 0;
        for frame in 1..=9 {
            hidden.predict(away, None);
            seen.predict(0, None);
            away += 1;
            let place = at(4.0 * f64::from(frame), f64::from(frame));
            seen.update(place, 3, 1);
            if !(4..9).contains(&frame) {
                hidden.update(place, 3, away);
                away = 0;
            }
        }
        let apart =
            hidden.filter.corners().into_iter().zip(seen.filter.corners()).map(|(a, b)| (a - b).abs());
        assert!(apart.fold(0.0, f64::max) < 1e-9);
    }

    #[test]
    fn long_out_of_sight() {
        let mut motion = Motion::new(at(0.0, 0.0));
        for away in 0..50 {
            motion.predict(away, None);
        }
        assert_eq!(motion.observed, [None; SLOTS]);
        assert_eq!(motion.observed_before(3), motion.last);
    }
}
