//! The physics of an attempt.

use super::{Grasp, GraspObject, MAX_WIDTH, PlanarGraspParams};
use crate::planar::vector::{norm, plus, turned};
use crate::planar::{Body, Convex, Drive, Part, Pose, World};

/// Half thickness (along the closing direction) and half width of a finger, m.
const FINGER: [f64; 2] = [0.005, 0.01];
const STEP: f64 = 0.01;
/// Steps of the physics for closing and for moving: 1.2 s and 0.4 s.
const CLOSING: usize = 120;
const MOVING: usize = 40;
/// Speed of a closing finger, m/s.
const CLOSING_SPEED: f64 = 0.05;
/// Motion with the object in the grip: m/s and rad/s.
const MOTION: [f64; 4] = [0.2, 0.15, 1.5, -CLOSING_SPEED];
/// How far an object that is held moves in the grip, m and rad.
const SLIP: (f64, f64) = (0.004, 0.1);
/// Fingers nearer than this hold nothing, m.
const EMPTY: f64 = 0.002;
/// Radius of a finger's patch of contact, m: what it resists of a torque about the closing direction.
const PATCH: f64 = 0.008;

/// What came of an attempt.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Outcome {
    /// The object was lifted and carried.
    Held,
    /// A finger came down on the object.
    Collided,
    /// The fingers closed on nothing.
    Missed,
    /// The object slipped out of the grip when the gripper moved, or turned under its weight.
    Slipped,
}

/// Attempts a grasp; `pose` becomes that of the object afterwards, which lies where it was pushed, or is put back where it was held.
pub(super) fn attempt(
    params: &PlanarGraspParams,
    object: GraspObject,
    grasp: &Grasp,
    pose: &mut Pose,
) -> Outcome {
    let finger = |side: f64| Part { shape: Convex::rectangle([side * FINGER[0], 0.0], FINGER), slides: side };
    let mut gripper = Body::fixed(&[finger(1.0), finger(-1.0)], params.friction).with_mass(1.0, 1e-3);
    (gripper.pose, gripper.slide_mass) = (Pose::new(grasp.place, grasp.angle), 0.3);
    gripper.slide = 0.5 * grasp.width.min(MAX_WIDTH);
    let drive = Drive { force: 60.0, length: 0.03, slide_force: params.force, ..Drive::default() };
    gripper.drive = Drive { target: [0.0, 0.0, 0.0, -CLOSING_SPEED], ..drive };
    let mut body = object.body(params.friction);
    body.pose = *pose;
    if overlap(&gripper, &body) {
        return Outcome::Collided;
    }
    let mut world = World::new(vec![gripper, body]);
    for _ in 0..CLOSING {
        world.advance(STEP);
        if world.bodies[0].slide < 0.5 * EMPTY {
            *pose = world.bodies[1].pose;
            return Outcome::Missed;
        }
    }
    *pose = world.bodies[1].pose;
    let in_grip = |world: &World| {
        let [gripper, body] = [0, 1].map(|at| world.bodies[at].pose);
        let (sine, cosine) = gripper.turn();
        (turned(plus(body.place, gripper.place, -1.0), (-sine, cosine)), body.angle - gripper.angle)
    };
    let (place, angle) = in_grip(&world);
    if !carries(params, &world, place[1]) {
        return Outcome::Slipped;
    }
    // Lifted: the table rubs no longer.
    world.bodies[1].drive = Drive::default();
    world.bodies[0].drive = Drive { target: MOTION, ..drive };
    (0..MOVING).for_each(|_| world.advance(STEP));
    let (then_place, then_angle) = in_grip(&world);
    let slipped = norm(plus(then_place, place, -1.0)) > SLIP.0 || (then_angle - angle).abs() > SLIP.1;
    if slipped { Outcome::Slipped } else { Outcome::Held }
}

/// Returns whether friction carries the weight and the torque of a centre of mass `aside` of the fingers (soft fingers: the limit
/// surface of force and torque is an ellipse; Howe and Cutkosky, 1996).
fn carries(params: &PlanarGraspParams, world: &World, aside: f64) -> bool {
    let weight = world.bodies[1].mass * 9.81;
    let limit = params.friction * world.pressed([0, 1]) / STEP;
    let torque = weight * aside / (2.0 / 3.0 * PATCH);
    norm([weight, torque]) < limit
}

/// Returns whether the fingers come down on the body.
fn overlap(gripper: &Body, body: &Body) -> bool {
    gripper.placed().any(|(finger, _)| {
        let parts = || body.placed();
        // Corners and middles of edges of either within the other: both are larger than half a finger.
        let points = |shape: &Convex| {
            shape
                .edges()
                .flat_map(|[start, end]| [start, plus(start, plus(end, start, -1.0), 0.5)])
                .collect::<Vec<_>>()
        };
        points(&finger).into_iter().any(|point| parts().any(|(part, _)| part.distance(point) < 0.0))
            || parts().any(|(part, _)| points(&part).into_iter().any(|point| finger.distance(point) < 0.0))
    })
}
