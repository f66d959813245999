//! One object of OC-SORT with what was observed of it.

use std::f64::consts::{FRAC_PI_2, PI};

use opendr_engine::target::Name;

use crate::tracking::camera_motion::PlaneMotion;
use crate::tracking::{AreaFilter, Life, SoundBox};

/// Directions are measured over at most so many frames.
pub(super) const MOST_FRAMES_BACK: usize = 10;
const SLOTS: usize = MOST_FRAMES_BACK + 1;

pub(super) struct Track {
    filter: AreaFilter,
    /// The filter as it was when the object was seen last.
    filter_when_seen: AreaFilter,
    /// Where it should be in this frame.
    pub expected: [f64; 4],
    /// Where it was seen last.
    pub last: [f64; 4],
    /// What was observed in the last frames, by the number of the frame.
    observed: [Option<[f64; 4]>; SLOTS],
    age: usize,
    /// The direction in which it moved, of length 1; `None` before it was seen twice.
    direction: Option<[f64; 2]>,
    pub name: Name,
    pub life: Life,
    /// Place of its box in the list of this frame, if it is in it.
    pub seen: Option<usize>,
}

impl Track {
    pub fn new(found: &SoundBox, name: Name) -> Self {
        let filter = AreaFilter::new(found.corners);
        let mut observed = [None; SLOTS];
        observed[0] = Some(found.corners);
        Self {
            filter,
            filter_when_seen: filter,
            expected: found.corners,
            last: found.corners,
            observed,
            age: 0,
            direction: None,
            name,
            life: Life::default(),
            seen: Some(found.index),
        }
    }

    /// One frame on.
    pub fn predict(&mut self) {
        self.filter.predict();
        self.expected = self.filter.corners();
        self.life.pass();
        self.seen = None;
        self.age = self.age.wrapping_add(1);
        self.observed[self.age % SLOTS] = None;
    }

    /// Takes in where it was seen in this frame.
    pub fn update(&mut self, found: &SoundBox, span: usize) {
        let before = self.observed_before(span);
        self.direction = direction(before, found.corners).or(self.direction);
        let frames = self.life.away;
        if frames > 1 {
            // Observation-centric re-update: the straight way from the last observation to this one.
            self.filter = self.filter_when_seen;
            for frame in 1..=frames {
                let share = f64::from(frame) / f64::from(frames);
                let between = |at: usize| self.last[at] + share * (found.corners[at] - self.last[at]);
                self.filter.predict();
                self.filter.update(std::array::from_fn(between));
            }
        } else {
            self.filter.update(found.corners);
        }
        self.filter_when_seen = self.filter;
        self.last = found.corners;
        self.observed[self.age % SLOTS] = Some(found.corners);
        self.seen = Some(found.index);
    }

    /// How well the way to `found` agrees with the direction so far: 0.5 for the same, -0.5 for the opposite, 0 where there
    /// is none.
    pub fn agreement(&self, found: [f64; 4], span: usize) -> f64 {
        let way = direction(self.observed_before(span), found);
        let cosine = self.direction.zip(way).map(|([x, y], [u, v])| (x * u + y * v).clamp(-1.0, 1.0));
        cosine.map_or(0.0, |cosine| (FRAC_PI_2 - cosine.acos()) / PI)
    }

    /// What was observed `span` frames ago, or as soon as possible after that.
    fn observed_before(&self, span: usize) -> [f64; 4] {
        let slot = |back: usize| self.observed[self.age.wrapping_sub(back) % SLOTS];
        (1..=span.min(self.age)).rev().find_map(slot).unwrap_or(self.last)
    }

    /// Takes in that the camera moved.
    pub fn move_camera(&mut self, motion: &PlaneMotion) {
        self.filter.move_camera(motion);
        self.filter_when_seen.move_camera(motion);
        self.last = motion.map_box(self.last);
        self.observed.iter_mut().flatten().for_each(|observed| *observed = motion.map_box(*observed));
        self.direction = self.direction.and_then(|direction| unit(motion.turn(direction)));
    }
}

/// The direction from the middle of one box to that of another.
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

    fn at(x: f64, y: f64) -> SoundBox {
        SoundBox { corners: [x, y, x + 20.0, y + 40.0], confidence: 1.0, index: 0 }
    }

    #[test]
    fn directions_agree_or_do_not() {
        let mut track = Track::new(&at(0.0, 0.0), Name::Index(0));
        assert_eq!(track.agreement([5.0, 0.0, 25.0, 40.0], 3), 0.0);
        for frame in 1..5 {
            track.predict();
            track.update(&at(10.0 * f64::from(frame), 0.0), 3);
            track.life.see(1, &mut 0);
        }
        track.predict();
        assert!((track.agreement(at(50.0, 0.0).corners, 3) - 0.5).abs() < 1e-9);
        assert!((track.agreement(at(-50.0, 0.0).corners, 3) + 0.5).abs() < 1e-9);
        // Three frames ago it was at 20.
        assert!(track.agreement(at(20.0, 90.0).corners, 3).abs() < 1e-9);
    }

    /// After a gap the filter is where it would be had the object been seen on the straight way.
    #[test]
    fn what_was_hidden_is_walked_again() {
        let mut hidden = Track::new(&at(0.0, 0.0), Name::Index(0));
        let mut seen = Track::new(&at(0.0, 0.0), Name::Index(0));
        for frame in 1..=9 {
            hidden.predict();
            seen.predict();
            let place = at(4.0 * f64::from(frame), f64::from(frame));
            seen.update(&place, 3);
            seen.life.see(1, &mut 0);
            if !(4..9).contains(&frame) {
                hidden.update(&place, 3);
                hidden.life.see(1, &mut 0);
            }
        }
        let apart =
            hidden.filter.corners().into_iter().zip(seen.filter.corners()).map(|(a, b)| (a - b).abs());
        assert!(apart.fold(0.0, f64::max) < 1e-9);
    }

    #[test]
    fn long_out_of_sight() {
        let mut track = Track::new(&at(0.0, 0.0), Name::Index(0));
        for _ in 0..50 {
            track.predict();
        }
        assert_eq!(track.observed, [None; SLOTS]);
        assert_eq!(track.observed_before(3), track.last);
    }
}
