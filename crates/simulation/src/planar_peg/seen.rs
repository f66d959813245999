//! What an observation shows.

use super::{OBSERVATION_LEN, OPENING, PEG, REACH};
use crate::planar::Pose;
use crate::planar::vector::{Vector2, plus, turned};

/// The state in an observation, in metres and radians.
#[derive(Debug, Clone, Copy)]
pub(super) struct Seen {
    pub gripper: Pose,
    /// Distance of each finger from the middle.
    opening: f64,
    /// The peg with the end in front that points to the wall: its angle is in [-pi/2, pi/2].
    pub peg: Pose,
    pub slot: f64,
}

impl Seen {
    pub fn new(observation: &[f32; OBSERVATION_LEN]) -> Self {
        let [x, y, cosine, sine, opening, peg_x, peg_y, peg_cosine, peg_sine, slot] =
            observation.map(f64::from);
        let front = if peg_cosine < 0.0 { -1.0 } else { 1.0 };
        Self {
            gripper: Pose::new([x * REACH, y * REACH], sine.atan2(cosine)),
            opening: opening * OPENING,
            peg: Pose::new([peg_x * REACH, peg_y * REACH], (front * peg_sine).atan2(front * peg_cosine)),
            slot: slot * REACH,
        }
    }

    /// Returns the place of a gripper that is this far behind the centre of the peg.
    pub fn grasp(&self, behind: f64) -> Vector2 {
        plus(self.peg.place, turned([0.0, -behind], self.peg.turn()), 1.0)
    }

    /// Returns the turn from the gripper to the peg.
    pub fn turn_to_peg(&self) -> f64 {
        self.peg.angle - self.gripper.angle
    }

    /// Returns whether the fingers are closed on the peg.
    pub fn holds(&self) -> bool {
        self.opening < PEG[1] + 0.001
    }
}
