//! Forward kinematics of a body.

use super::body_shape::BodyShape;
use super::frame::{AHEAD, Frame, LEFT, UP};
use super::motion::JointAngles;
use crate::raycast::Vector;

/// Frames of the bones of a posed body. The bone of a limb extends down from its frame; arrays are left, right.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Bones {
    pub pelvis: Frame,
    pub chest: Frame,
    pub head: Frame,
    pub upper_arm: [Frame; 2],
    pub forearm: [Frame; 2],
    pub hand: [Frame; 2],
    pub thigh: [Frame; 2],
    pub shank: [Frame; 2],
    pub foot: [Frame; 2],
}

/// Height of the bend of the spine above the hips, as a share of the trunk.
const WAIST: f32 = 0.35;

impl Bones {
    /// Poses a body whose middle of the hips is at `position`; it faces `yaw`, rad.
    pub fn pose(shape: &BodyShape, angles: &JointAngles, position: Vector, yaw: f32) -> Self {
        let pelvis = Frame::upright(position, yaw);
        let waist = pelvis.moved([0.0, 0.0, WAIST * shape.trunk()]);
        let chest = waist.turned(LEFT, angles.bend).turned(AHEAD, -angles.lean);
        let neck = chest.moved([0.0, 0.0, (1.0 - WAIST) * shape.trunk()]);
        let [aside, down] = angles.head;
        let head = neck.turned(UP, aside).turned(LEFT, down).moved([0.015 * shape.height, 0.0, shape.neck()]);
        let limbs = [0, 1].map(|side| Limbs::pose(shape, angles, side, pelvis, neck));
        let each = |part: fn(&Limbs) -> Frame| [part(&limbs[0]), part(&limbs[1])];
        Self {
            pelvis,
            chest,
            head,
            upper_arm: each(|limbs| limbs.upper_arm),
            forearm: each(|limbs| limbs.forearm),
            hand: each(|limbs| limbs.hand),
            thigh: each(|limbs| limbs.thigh),
            shank: each(|limbs| limbs.shank),
            foot: each(|limbs| limbs.foot),
        }
    }

    /// Returns the height of the lowest ankle minus its height above the sole.
    pub fn sole(&self, shape: &BodyShape) -> f32 {
        self.foot[0].position[2].min(self.foot[1].position[2]) - shape.ankle()
    }

    /// Returns the body moved up by `rise`, metres.
    pub fn raised(mut self, rise: f32) -> Self {
        let middle = [&mut self.pelvis, &mut self.chest, &mut self.head];
        let arms = self.upper_arm.iter_mut().chain(&mut self.forearm).chain(&mut self.hand);
        let legs = self.thigh.iter_mut().chain(&mut self.shank).chain(&mut self.foot);
        middle.into_iter().chain(arms).chain(legs).for_each(|frame| frame.position[2] += rise);
        self
    }

    /// Returns COCO's 17 key points: nose, eyes, ears, shoulders, elbows, wrists, hips, knees, ankles, left before right.
    pub fn keypoints(&self, shape: &BodyShape) -> [Vector; 17] {
        let size = shape.height;
        let face = |ahead: f32, left: f32, up: f32| self.head.point([ahead * size, left * size, up * size]);
        let [left, right] = [0, 1];
        [
            face(0.06, 0.0, -0.005),
            face(0.05, 0.018, 0.01),
            face(0.05, -0.018, 0.01),
            face(0.0, 0.043, 0.0),
            face(0.0, -0.043, 0.0),
            self.upper_arm[left].position,
            self.upper_arm[right].position,
            self.forearm[left].position,
            self.forearm[right].position,
            self.hand[left].position,
            self.hand[right].position,
            self.thigh[left].position,
            self.thigh[right].position,
            self.shank[left].position,
            self.shank[right].position,
            self.foot[left].position,
            self.foot[right].position,
        ]
    }
}

/// Frames of the limbs of a side.
struct Limbs {
    upper_arm: Frame,
    forearm: Frame,
    hand: Frame,
    thigh: Frame,
    shank: Frame,
    foot: Frame,
}

impl Limbs {
    fn pose(shape: &BodyShape, angles: &JointAngles, side: usize, pelvis: Frame, neck: Frame) -> Self {
        let outwards = [1.0, -1.0][side];
        let shoulder = neck.moved([0.0, outwards * shape.half_shoulders(), -0.02 * shape.height]);
        let upper_arm = shoulder
            .turned(AHEAD, outwards * angles.raise[side])
            .turned(LEFT, -angles.shoulder[side])
            .turned(UP, -outwards * angles.twist[side]);
        let forearm = upper_arm.moved([0.0, 0.0, -shape.upper_arm()]).turned(LEFT, -angles.elbow[side]);
        let hand = forearm.moved([0.0, 0.0, -shape.forearm()]);
        let hip = pelvis.moved([0.0, outwards * shape.half_hips(), 0.0]);
        let thigh = hip.turned(AHEAD, outwards * angles.straddle[side]).turned(LEFT, -angles.hip[side]);
        let shank = thigh.moved([0.0, 0.0, -shape.thigh()]).turned(LEFT, angles.knee[side]);
        let foot = shank.moved([0.0, 0.0, -shape.shank()]);
        Self { upper_arm, forearm, hand, thigh, shank, foot }
    }
}
