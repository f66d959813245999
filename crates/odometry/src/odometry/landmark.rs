//! Landmarks: corners that are followed, with their points.

use crate::geometry::Vector;

/// Where a key frame saw a landmark.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Observation {
    /// Number of the key frame.
    pub key: u32,
    pub pixel: [f32; 2],
    /// Column in the right image of the pair; NaN if unknown.
    pub right: f32,
}

/// Most key frames of a window.
pub(super) const MOST: usize = 8;

/// A corner that is, or was, followed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Landmark {
    /// Point in the world, once known.
    pub point: Option<Vector>,
    /// Place in the last tracked frame.
    pub place: [f32; 2],
    pub is_followed: bool,
    seen: [Observation; MOST],
    count: usize,
}

impl Landmark {
    pub fn new(place: [f32; 2], point: Option<Vector>) -> Self {
        Self { point, place, is_followed: true, seen: [Observation::default(); MOST], count: 0 }
    }

    /// Returns the observations, oldest first.
    pub fn seen(&self) -> &[Observation] {
        &self.seen[..self.count]
    }

    /// Adds the newest observation; the oldest of more than [`MOST`] is dropped.
    pub fn see(&mut self, observation: Observation) {
        if self.count == MOST {
            self.seen.rotate_left(1);
            self.count -= 1;
        }
        self.seen[self.count] = observation;
        self.count += 1;
    }

    /// Drops observations of key frames before `key`.
    pub fn forget(&mut self, key: u32) {
        let old = self.seen().iter().take_while(|seen| seen.key < key).count();
        self.seen.rotate_left(old);
        self.count -= old;
    }
}
