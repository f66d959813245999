//! Closed-form inverse kinematics of arms with seven joints.

use std::f64::consts::TAU;

use opendr_engine::{Error, Result};

use super::chain::SerialChain;
use super::transform::Transform;
use crate::arctangent::{arctangent2, wrapped};
use crate::multirotor::{Vector, dot, minus, plus};
use crate::sine_cosine::sine_cosine;

/// Angles of the seven joints, in radians.
pub type JointAngles = [f64; 7];

/// An arm whose joints turn about z, y, x, y, x, y, x: pan, lift and roll of the shoulder, elbow, and roll, flex, roll of the
/// wrist. All links lie along x at angles of 0; the lift may be ahead of the pan, as in a PR2.
///
/// For each angle of the pan, the other six follow in closed form; the pan is the redundancy of the arm, over which
/// [`RollArm::inverse`] searches.
#[derive(Debug, Clone, PartialEq)]
pub struct RollArm {
    chain: SerialChain,
    /// Point on the axis of the pan at the height of the lift.
    shoulder: Vector,
    /// Distances along x: pan to lift, lift to elbow, elbow to wrist, wrist to tip.
    offset: f64,
    upper: f64,
    fore: f64,
    hand: f64,
    /// Ranges of the joints; infinite for continuous ones.
    ranges: [[f64; 2]; 7],
}

/// Axes of the joints.
const AXES: [usize; 7] = [2, 1, 0, 1, 0, 1, 0];
/// Step of the search over the pan, radians.
const PAN_STEP: f64 = 0.05;
/// Steps to either side of the present pan among which the best solution is chosen.
const NEAR: i32 = 6;
/// Largest error of a returned pose: metres, and parts of unit vectors.
const TOLERANCE: f64 = 1e-9;
/// Weight of the distance to the ends of the ranges, against the squared motion in radians.
const CENTRING: f64 = 0.02;

impl RollArm {
    /// Creates the arm of a chain.
    ///
    /// # Errors
    /// `Unsupported` for a chain of another structure.
    pub fn new(chain: SerialChain) -> Result<Self> {
        let joints = chain.joints();
        if joints.len() != AXES.len() {
            return Err(Error::unsupported(format!("an arm with {} joints; give one with 7", joints.len())));
        }
        for (index, (joint, axis)) in joints.iter().zip(AXES).enumerate() {
            let Transform { position: [_, y, z], rotation } = joint.origin;
            // The pan's origin and the height of the lift are free.
            let straight = index == 0 || (y.abs() < 1e-9 && (index == 1 || z.abs() < 1e-9));
            let upright = rotation == Transform::default().rotation;
            if !(straight && upright && joint.axis[axis] > 1.0 - 1e-12) {
                return Err(Error::unsupported(format!(
                    "joint {:?} of the arm; its axis must be {} with links along x and no rotation of its origin",
                    joint.name,
                    ["x", "y", "z"][axis]
                )));
            }
        }
        let along =
            |index: usize| joints.get(index).map_or(0.0, |joint: &super::Joint| joint.origin.position[0]);
        let Transform { position: [hand, y, z], rotation } = chain.tip;
        if y.abs().max(z.abs()) > 1e-9 || rotation != Transform::default().rotation {
            return Err(Error::unsupported(
                "a tip beside the last axis; give a link along x of the last joint",
            ));
        }
        let height = joints.get(1).map_or(0.0, |joint| joint.origin.position[2]);
        let origin = joints.first().map_or([0.0; 3], |joint| joint.origin.position);
        let mut ranges = [[f64::NEG_INFINITY, f64::INFINITY]; 7];
        for (range, joint) in ranges.iter_mut().zip(joints) {
            *range = joint.range.unwrap_or(*range);
        }
        Ok(Self {
            shoulder: plus(origin, [0.0, 0.0, height], 1.0),
            offset: along(1),
            upper: along(2) + along(3),
            fore: along(4) + along(5),
            hand: along(6) + hand,
            ranges,
            chain,
        })
    }

    /// Returns the chain of the arm.
    pub fn chain(&self) -> &SerialChain {
        &self.chain
    }

    /// Returns the ranges of the joints in radians; infinite for continuous joints.
    pub fn ranges(&self) -> &[[f64; 2]; 7] {
        &self.ranges
    }

    /// Returns the pose of the tip.
    pub fn forward(&self, angles: &JointAngles) -> Transform {
        self.chain.forward(angles)
    }

    /// Returns angles within the ranges of the joints for a pose of the tip; none if the search over the pan finds none.
    ///
    /// Among the solutions with a pan within 0.3 rad of `near`, that with the least motion from `near` and distance from the middle
    /// of the ranges is chosen; if there is none, the one with the nearest pan.
    pub fn inverse(&self, target: &Transform, near: &JointAngles) -> Option<JointAngles> {
        let [low, high] = self.ranges[0];
        let start = near[0].clamp(low.max(-TAU), high.min(TAU));
        let mut best = Best { cost: f64::INFINITY, angles: None };
        let wrist = minus(minus(target.position, target.rotation[0], self.hand), self.shoulder, 1.0);
        // Two full turns at most.
        for step in 0..(2.0 * TAU / PAN_STEP) as i32 {
            let sides = [start + f64::from(step) * PAN_STEP, start - f64::from(step) * PAN_STEP];
            let sides = &sides[..if step == 0 { 1 } else { 2 }];
            if sides.iter().all(|pan| *pan < low || *pan > high) {
                break;
            }
            for pan in sides.iter().filter(|pan| (low..=high).contains(*pan)) {
                self.solve(*pan, wrist, target, near, &mut best);
            }
            if step >= NEAR && best.angles.is_some() {
                break;
            }
        }
        best.angles.filter(|angles| self.reaches(angles, target))
    }

    /// Returns whether the arm with these angles is at the target.
    fn reaches(&self, angles: &JointAngles, target: &Transform) -> bool {
        let found = self.forward(angles);
        let parts = found.rotation.iter().flatten().chain(&found.position);
        let wanted = target.rotation.iter().flatten().chain(&target.position);
        parts.zip(wanted).all(|(found, wanted)| (found - wanted).abs() < TOLERANCE)
    }

    /// Takes in all solutions for one angle of the pan. `wrist` is the centre of the wrist from the shoulder.
    fn solve(&self, pan: f64, wrist: Vector, target: &Transform, near: &JointAngles, best: &mut Best) {
        let (pan_sine, pan_cosine) = sine_cosine(pan);
        // The wrist from the lift, in the frame after the pan.
        let x = pan_cosine * wrist[0] + pan_sine * wrist[1] - self.offset;
        let y = pan_cosine * wrist[1] - pan_sine * wrist[0];
        let z = wrist[2];
        let square = x * x + y * y + z * z;
        let lengths = self.upper * self.upper + self.fore * self.fore;
        let elbow_cosine = (square - lengths) / (2.0 * self.upper * self.fore);
        if !(-1.0..1.0).contains(&elbow_cosine) {
            return;
        }
        let elbow_sine = (1.0 - elbow_cosine * elbow_cosine).sqrt();
        for elbow_sine in [-elbow_sine, elbow_sine] {
            let elbow = arctangent2(elbow_sine, elbow_cosine);
            // The wrist from the lift, in the frame after the roll.
            let (ahead, up) = (self.upper + self.fore * elbow_cosine, -self.fore * elbow_sine);
            let roll_sine = -y / up;
            if !self.allows(3, elbow) || !(-1.0..=1.0).contains(&roll_sine) {
                continue;
            }
            let roll_cosine = (1.0 - roll_sine * roll_sine).sqrt();
            for roll_cosine in [roll_cosine, -roll_cosine] {
                let raised = roll_cosine * up;
                let (lift_sine, lift_cosine) = (raised * x - ahead * z, ahead * x + raised * z);
                let size = (lift_sine * lift_sine + lift_cosine * lift_cosine).sqrt();
                let lift = arctangent2(lift_sine, lift_cosine);
                let roll = self.nearest(2, arctangent2(roll_sine, roll_cosine), near[2]);
                if size < 1e-12 || !self.allows(1, lift) || !self.allows(2, roll) {
                    continue;
                }
                let lift_turn = [lift_sine / size, lift_cosine / size];
                let turns =
                    [[pan_sine, pan_cosine], lift_turn, [roll_sine, roll_cosine], [elbow_sine, elbow_cosine]];
                self.solve_wrist([pan, lift, roll, elbow], &turns, target, near, best);
            }
        }
    }

    /// Takes in the solutions of the wrist behind the first four joints, whose sines and cosines are `turns`.
    fn solve_wrist(
        &self,
        [pan, lift, roll, elbow]: [f64; 4],
        turns: &[[f64; 2]; 4],
        target: &Transform,
        near: &JointAngles,
        best: &mut Best,
    ) {
        let [fore_x, fore_y, fore_z] = fore_axes(turns);
        let [hand_x, hand_y, hand_z] = target.rotation;
        // Rotation from the forearm to the hand, as products of roll, flex and roll.
        let flex_cosine = dot(fore_x, hand_x).clamp(-1.0, 1.0);
        let flex_sine = (1.0 - flex_cosine * flex_cosine).sqrt();
        if flex_sine < 1e-9 {
            return;
        }
        for sign in [-1.0, 1.0] {
            let flex = arctangent2(sign * flex_sine, flex_cosine);
            if !self.allows(5, flex) {
                continue;
            }
            let inner = arctangent2(sign * dot(fore_y, hand_x), -sign * dot(fore_z, hand_x));
            let outer = arctangent2(sign * dot(fore_x, hand_y), sign * dot(fore_x, hand_z));
            let (inner, outer) = (self.nearest(4, inner, near[4]), self.nearest(6, outer, near[6]));
            if self.allows(4, inner) && self.allows(6, outer) {
                best.take([pan, lift, roll, elbow, inner, flex, outer], near, &self.ranges);
            }
        }
    }

    /// Returns the equivalent of an angle that is nearest to another one, within the range of a joint if there is one.
    fn nearest(&self, joint: usize, angle: f64, near: f64) -> f64 {
        let angle = near + wrapped(angle - near);
        let others = [angle, angle - TAU, angle + TAU];
        others.into_iter().find(|angle| self.allows(joint, *angle)).unwrap_or(angle)
    }

    fn allows(&self, joint: usize, angle: f64) -> bool {
        let [low, high] = self.ranges[joint];
        (low..=high).contains(&angle)
    }
}

/// Returns the axes of the forearm from the sines and cosines of pan, lift, roll and elbow.
fn fore_axes([[s1, c1], [s2, c2], [s3, c3], [s4, c4]]: &[[f64; 2]; 4]) -> [Vector; 3] {
    let upper_x = [c1 * c2, s1 * c2, -s2];
    let (side, up) = ([-s1, *c1, 0.0], [c1 * s2, s1 * s2, *c2]);
    let fore_y: Vector = std::array::from_fn(|row| c3 * side[row] + s3 * up[row]);
    let upper_z: Vector = std::array::from_fn(|row| c3 * up[row] - s3 * side[row]);
    [
        std::array::from_fn(|row| c4 * upper_x[row] - s4 * upper_z[row]),
        fore_y,
        std::array::from_fn(|row| s4 * upper_x[row] + c4 * upper_z[row]),
    ]
}

/// The best solution so far.
struct Best {
    cost: f64,
    angles: Option<JointAngles>,
}

impl Best {
    fn take(&mut self, angles: JointAngles, near: &JointAngles, ranges: &[[f64; 2]; 7]) {
        let mut cost = 0.0;
        for ((angle, near), [low, high]) in angles.iter().zip(near).zip(ranges) {
            cost += (angle - near) * (angle - near);
            if low.is_finite() {
                let share = (2.0 * angle - low - high) / (high - low);
                cost += CENTRING * (share * share).powi(3);
            }
        }
        if cost < self.cost {
            *self = Self { cost, angles: Some(angles) };
        }
    }
}
