//! Joint angles of persons who stand, walk, sit, reach and gesture.

use std::f32::consts::{FRAC_PI_2, TAU};

use opendr_engine::Random;

/// Joint angles of a body, rad; arrays are left, right.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct JointAngles {
    /// Trunk to the front.
    pub bend: f32,
    /// Trunk to the left.
    pub lean: f32,
    /// Head to the left, and down.
    pub head: [f32; 2],
    /// Thigh to the front.
    pub hip: [f32; 2],
    /// Thigh outwards.
    pub straddle: [f32; 2],
    /// Bend of the knee.
    pub knee: [f32; 2],
    /// Upper arm to the front.
    pub shoulder: [f32; 2],
    /// Upper arm outwards.
    pub raise: [f32; 2],
    /// Rotation of the upper arm about itself, inwards.
    pub twist: [f32; 2],
    /// Bend of the elbow.
    pub elbow: [f32; 2],
}

impl JointAngles {
    /// Draws angles within the range of human joints.
    pub fn draw(random: &mut Random) -> Self {
        let mut angles = match random.below(10) {
            0..4 => Self::walking(random),
            4..8 => Self::standing(random),
            _ => Self::sitting(random),
        };
        for side in 0..2 {
            match random.below(6) {
                0 => angles.reach(side, random),
                1 => angles.lift(side, random),
                _ => {}
            }
        }
        angles.head = [random.uniform(-0.9, 0.9), random.uniform(-0.3, 0.5)];
        angles.lean += random.uniform(-0.12, 0.12);
        angles
    }

    /// A phase of a stride, with the arms in opposition.
    fn walking(random: &mut Random) -> Self {
        let (phase, stride) = (random.uniform(0.0, TAU), random.uniform(0.2, 0.55));
        let mut angles = Self { bend: random.uniform(0.0, 0.2), ..Self::default() };
        for (side, phase) in [phase, phase + TAU / 2.0].into_iter().enumerate() {
            angles.hip[side] = stride * phase.sin() + 0.05;
            // The knee bends most while the leg swings to the front.
            angles.knee[side] = 0.1 + 1.6 * stride * (phase + 1.0).cos().max(0.0);
            angles.shoulder[side] = -0.8 * stride * phase.sin();
            angles.raise[side] = random.uniform(0.05, 0.2);
            angles.elbow[side] = random.uniform(0.1, 0.7);
        }
        angles
    }

    fn standing(random: &mut Random) -> Self {
        let mut angles = Self { bend: random.uniform(-0.05, 0.3), ..Self::default() };
        for side in 0..2 {
            angles.hip[side] = random.uniform(-0.08, 0.1);
            angles.straddle[side] = random.uniform(0.0, 0.18);
            angles.knee[side] = random.uniform(0.0, 0.15);
            angles.shoulder[side] = random.uniform(-0.2, 0.3);
            angles.raise[side] = random.uniform(0.05, 0.4);
            angles.twist[side] = random.uniform(-0.3, 0.9);
            angles.elbow[side] = random.uniform(0.05, 1.6);
        }
        angles
    }

    fn sitting(random: &mut Random) -> Self {
        let mut angles = Self { bend: random.uniform(-0.25, 0.35), ..Self::standing(random) };
        for side in 0..2 {
            angles.hip[side] = FRAC_PI_2 + random.uniform(-0.15, 0.15);
            angles.straddle[side] = random.uniform(0.0, 0.35);
            angles.knee[side] = FRAC_PI_2 + random.uniform(-0.4, 0.3);
        }
        angles
    }

    /// Stretches an arm to the front.
    fn reach(&mut self, side: usize, random: &mut Random) {
        self.shoulder[side] = random.uniform(0.7, 1.7);
        self.raise[side] = random.uniform(-0.1, 0.5);
        self.elbow[side] = random.uniform(0.0, 0.9);
    }

    /// Raises an arm beside the head.
    fn lift(&mut self, side: usize, random: &mut Random) {
        self.raise[side] = random.uniform(1.2, 2.9);
        self.shoulder[side] = random.uniform(-0.2, 0.4);
        self.elbow[side] = random.uniform(0.0, 1.8);
    }
}
