//! Tasks: where the base begins and where the gripper goes.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use opendr_engine::Random;

use super::motion::Goal;
use crate::kinematics::Transform;
use crate::sine_cosine::sine_cosine;

/// What the gripper does.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Task {
    /// Moves to a random pose 1 m to 5 m away.
    Reach,
    /// Takes an object from a table and puts it on another one.
    PickPlace,
    /// Takes the handle of a door and opens it.
    Door,
    /// Takes the handle of a drawer and pulls.
    Drawer,
}

/// A motion of a task.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Leg {
    pub goal: Goal,
    /// Steps for which the gripper waits before it, e.g. to close.
    pub pause: u32,
}

/// Distance from the wrist to the tip of the gripper, metres.
const TIP: f64 = 0.18;
/// Distance before an object at which the gripper stops first, metres.
const BEFORE: f64 = 0.2;
/// Steps of a pause: 2 s.
const PAUSE: u32 = 20;
/// Distance from the middle to tables and cabinets, metres.
const FURNITURE: f64 = 3.3;

/// Draws the pose of the base and the motions of an episode.
pub(super) fn draw(task: Task, random: &mut Random) -> ([f64; 3], Vec<Leg>) {
    let mut between = |low: f64, high: f64| low + (high - low) * random.unit();
    if task == Task::Reach {
        let (distance, bearing) = (between(1.0, 5.0), between(-PI, PI));
        let (sine, cosine) = sine_cosine(bearing);
        let position = [distance * cosine, distance * sine, between(0.2, 1.2)];
        let turn = Transform::from_rpy([(); 3].map(|()| between(0.0, TAU)));
        return ([0.0; 3], vec![line(Transform { position, ..turn }, 0)]);
    }
    let [x, y] = [(); 2].map(|()| between(-1.0, 1.0));
    let half_turn = between(-FRAC_PI_2, FRAC_PI_2);
    match task {
        Task::Reach | Task::PickPlace => {
            let pick = wrist([FURNITURE - 0.3, between(-0.4, 0.4), between(0.45, 0.85)], 0.0);
            let put = wrist([between(-1.5, 2.0), between(-3.0, -2.5), between(0.45, 0.85)], -FRAC_PI_2);
            let legs = [line(before(&pick), 0), line(pick, 0), line(before(&put), PAUSE), line(put, 0)];
            ([x, y, half_turn], legs.to_vec())
        }
        Task::Door => {
            let handle = [between(-0.3, 0.3), FURNITURE - 0.2, between(0.45, 0.95)];
            let (width, side) = (between(0.3, 0.4), if between(0.0, 1.0) < 0.5 { -1.0 } else { 1.0 });
            let closed = wrist(handle, FRAC_PI_2);
            let hinge = [handle[0] + side * width, handle[1]];
            let open = Goal::Arc { from: closed, hinge, angle: side * between(1.0, 1.4) };
            let legs = [line(before(&closed), 0), line(closed, 0), Leg { goal: open, pause: PAUSE }];
            ([x, y, FRAC_PI_2 + half_turn], legs.to_vec())
        }
        Task::Drawer => {
            let closed = wrist([0.2 - FURNITURE, between(-0.3, 0.3), between(0.4, 0.9)], PI);
            let mut open = closed;
            open.position[0] += between(0.25, 0.4);
            let legs = [line(before(&closed), 0), line(closed, 0), line(open, PAUSE)];
            ([x, y, PI + half_turn], legs.to_vec())
        }
    }
}

fn line(goal: Transform, pause: u32) -> Leg {
    Leg { goal: Goal::Line(goal), pause }
}

/// Returns the pose of the wrist whose tip points level at a place, with a yaw.
fn wrist(tip: [f64; 3], yaw: f64) -> Transform {
    let pose = Transform { position: tip, ..Transform::on_floor([0.0, 0.0, yaw]) };
    pose.then(&Transform::at([-TIP, 0.0, 0.0]))
}

fn before(pose: &Transform) -> Transform {
    pose.then(&Transform::at([-BEFORE, 0.0, 0.0]))
}
