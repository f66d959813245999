//! Motion of the base.

use opendr_engine::Random;

use super::{BASE_SPEED, BaseKind, CONTROL_PERIOD, MobileManipulationParams, Strategy, TURN_RATE};
use crate::arctangent::{arctangent2, wrapped};
use crate::sine_cosine::sine_cosine;

/// Largest motion and turn in a step, in metres and radians.
const STRIDE: f64 = BASE_SPEED * CONTROL_PERIOD;
const TURN: f64 = TURN_RATE * CONTROL_PERIOD;

/// Pose on the floor: x, y and yaw.
pub(super) type FloorPose = [f64; 3];

/// Returns the pose after a step, and the cost of the action before scaling. `gripper` is the planned motion of the gripper in
/// the frame of the base.
pub(super) fn advance(
    pose: FloorPose,
    action: &[f64],
    gripper: [f64; 2],
    params: &MobileManipulationParams,
    random: &mut Random,
) -> (FloorPose, f64) {
    let ([mut ahead, mut left, mut turn], cost) = match params.base {
        BaseKind::Omni => omni(action, gripper, params.strategy),
        BaseKind::Diff => diff(action, gripper, params.strategy),
    };
    if params.base_noise > 0.0 {
        ahead += params.base_noise * random.normal();
        if params.base == BaseKind::Omni {
            left += params.base_noise * random.normal();
        }
        turn += params.base_noise * random.normal();
    }
    let [x, y, yaw] = pose;
    // A differential drive turns first, as in OpenDR.
    let heading = if params.base == BaseKind::Diff { yaw + turn } else { yaw };
    let (sine, cosine) = sine_cosine(heading);
    let moved = [x + cosine * ahead - sine * left, y + sine * ahead + cosine * left, wrapped(yaw + turn)];
    (moved, cost)
}

/// Returns motion ahead, to the left and turn, and the cost.
fn omni(action: &[f64], gripper: [f64; 2], strategy: Strategy) -> ([f64; 3], f64) {
    let [turn, ahead, left] = std::array::from_fn(|at| action.get(at).copied().unwrap_or(0.0));
    let planned = if strategy == Strategy::Dirvel { [0.0; 2] } else { clipped(gripper) };
    let wanted = [planned[0] + STRIDE * ahead, planned[1] + STRIDE * left];
    let cost = match strategy {
        Strategy::Dirvel | Strategy::Relvelm => turn * turn + ahead * ahead + left * left,
        Strategy::Relveld => {
            turn * turn + (wanted[0] * wanted[0] + wanted[1] * wanted[1]) / (STRIDE * STRIDE)
        }
    };
    let [ahead, left] = clipped(wanted);
    ([ahead, left, TURN * turn], cost)
}

fn diff(action: &[f64], gripper: [f64; 2], strategy: Strategy) -> ([f64; 3], f64) {
    let [speed, turn] = std::array::from_fn(|at| action.get(at).copied().unwrap_or(0.0));
    if strategy == Strategy::Dirvel {
        return ([STRIDE * speed, 0.0, TURN * turn], speed * speed + turn * turn);
    }
    let [x, y] = clipped(gripper);
    let planned = (x * x + y * y).sqrt();
    let ahead = if x < 0.0 { -planned } else { planned } + STRIDE * speed;
    // The angle between the motion of the base and that of the gripper.
    let angle = arctangent2(ahead * y, ahead * x).clamp(-TURN, TURN) + TURN * turn;
    let ahead = ahead.clamp(-STRIDE, STRIDE);
    let cost = match strategy {
        Strategy::Relveld => turn * turn + (ahead / STRIDE) * (ahead / STRIDE),
        _ => speed * speed + turn * turn,
    };
    ([ahead, 0.0, angle.clamp(-TURN, TURN)], cost)
}

/// Returns a motion of at most the largest stride.
fn clipped([x, y]: [f64; 2]) -> [f64; 2] {
    let size = (x * x + y * y).sqrt();
    let share = if size > STRIDE { STRIDE / size } else { 1.0 };
    [share * x, share * y]
}
