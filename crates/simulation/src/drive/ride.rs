//! Motion of the camera along the road.

use std::f32::consts::TAU;

use opendr_engine::Random;

use super::DriveOptions;
use super::course::Road;
use crate::raycast::Pose;
use crate::sine_cosine::sine_cosine;

/// The camera's way: the road with the vehicle's rise, pitch and roll.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Ride {
    pub road: Road,
    /// Metres between frames.
    step: f64,
    height: f64,
    shake: f64,
    /// Waves per metre and phase of rise, pitch and roll, two each.
    waves: [[[f64; 2]; 2]; 3],
}

/// Rows of world_from_camera: rotation and position of a camera with x right, y down and z ahead.
pub(super) type CameraPose = [[f64; 4]; 3];

impl Ride {
    pub fn new(road: Road, options: &DriveOptions, random: &mut Random) -> Self {
        let mut wave = |low, high| [random.uniform(low, high), random.uniform(0.0, TAU)].map(f64::from);
        let waves = [(); 3].map(|()| [wave(0.1, 0.4), wave(0.8, 1.6)]);
        let step = options.speed / options.rate;
        Self { road, step, height: options.camera_height, shake: options.shake, waves }
    }

    pub fn frames(&self) -> usize {
        (self.road.length / self.step) as usize + 1
    }

    pub fn pose(&self, frame: usize) -> CameraPose {
        let distance = frame as f64 * self.step;
        let place = self.road.at(distance);
        let [rise, pitch, roll] = self.waves.map(|waves| {
            let wave = |[per_metre, phase]: [f64; 2]| sine_cosine(per_metre * distance + phase).0;
            self.shake * (0.7 * wave(waves[0]) + 0.3 * wave(waves[1]))
        });
        let ([sy, cy], [sp, cp], [sr, cr]) = (both(place.yaw), both(pitch), both(roll));
        // Axes of the vehicle: yaw about up, pitch (downwards positive) about left, roll about ahead.
        let ahead = [cy * cp, sy * cp, -sp];
        let level_left = [-sy, cy, 0.0];
        let level_up = [cy * sp, sy * sp, cp];
        let left: [f64; 3] = std::array::from_fn(|axis| cr * level_left[axis] + sr * level_up[axis]);
        let up: [f64; 3] = std::array::from_fn(|axis| cr * level_up[axis] - sr * level_left[axis]);
        let [x, y] = place.position;
        let position = [x, y, self.height + rise];
        std::array::from_fn(|axis| [-left[axis], -up[axis], ahead[axis], position[axis]])
    }
}

/// Returns the ray caster's pose of a camera, moved to the right.
pub(super) fn raycast_pose(pose: &CameraPose, right: f64) -> Pose {
    let column = |number: usize, sign: f64| std::array::from_fn(|axis| (sign * pose[axis][number]) as f32);
    let position = std::array::from_fn(|axis| (pose[axis][3] + right * pose[axis][0]) as f32);
    Pose { position, axes: [column(2, 1.0), column(0, -1.0), column(1, -1.0)] }
}

fn both(angle: f64) -> [f64; 2] {
    sine_cosine(angle).into()
}
