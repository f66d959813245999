//! Mobile manipulation: a base that a controller places, its arm with seven motors, and the goals of the gripper.

use opendr_engine::Result;
use opendr_simulation::kinematics::{SERVICE_ARM, SerialChain, Transform};
use opendr_simulation::mobile_manipulation::{MobileManipulation, MobileManipulationParams, Task};

use super::episode::Episode;
use super::node::Node;
use super::rotation::axis_angle;
use super::world::{Physics, UPRIGHT, World, cuboid, placed, robot, shape};

/// Side of the base and its height, m.
const BASE: [f64; 3] = [0.65, 0.65, 0.3];
const THICKNESS: f64 = 0.07;

pub(super) fn world(episode: &Episode) -> Result<World> {
    let task = match &episode.id {
        id if id.contains("PickPlace") => Task::PickPlace,
        id if id.contains("Door") => Task::Door,
        id if id.contains("Drawer") => Task::Drawer,
        _ => Task::Reach,
    };
    let params = episode.params::<MobileManipulationParams>()?;
    let mut environment = MobileManipulation::called(&episode.id, task, &params)?;
    episode.reset(&mut environment)?;
    let physics = Physics { step_ms: 50.0, gravity: 9.81 };
    let mut world = World::new(episode, &physics, [-7.0, 0.0, 6.0], [0.0, 1.0, 0.0, 0.6]);
    let floor = Node::new("Solid")
        .nodes("children", vec![shape(Node::new("Plane").numbers("size", &[16.0, 16.0]), [0.7, 0.7, 0.68])])
        .text("name", "floor");
    world = world.with(floor);
    for (number, goal) in environment.goals().iter().enumerate() {
        world = world.with(marker(number, goal));
    }
    let [x, y, yaw] = environment.base().unwrap_or_default();
    let chain = SerialChain::from_urdf(SERVICE_ARM, "wrist")?;
    let mut parts = vec![
        placed([0.0, 0.0, BASE[2] / 2.0], UPRIGHT, vec![shape(cuboid(BASE), [0.8, 0.82, 0.86])]),
        placed([-0.1, 0.0, 0.6], UPRIGHT, vec![shape(cuboid([0.3, 0.35, 0.7]), [0.6, 0.63, 0.7])]),
        Node::new("GPS").text("name", "position"),
        Node::new("InertialUnit").text("name", "orientation"),
    ];
    parts.push(arm(&chain, &environment.joints().unwrap_or_default()));
    let robot = robot("service robot", parts)
        .numbers("translation", &[x, y, 0.0])
        .numbers("rotation", &[0.0, 0.0, 1.0, yaw]);
    Ok(world.with(robot))
}

/// Returns axes at the end of a motion of the gripper.
fn marker(number: usize, goal: &Transform) -> Node {
    let axis = |axis: usize| {
        let mut size = [0.012; 3];
        size[axis] = 0.15;
        let mut centre = [0.0; 3];
        centre[axis] = 0.075;
        let mut colour = [0.15; 3];
        colour[axis] = 0.9;
        placed(centre, UPRIGHT, vec![shape(cuboid(size), colour)])
    };
    Node::defined(&format!("GOAL_{number}"), "Solid")
        .numbers("translation", &goal.position)
        .numbers("rotation", &rotation(goal))
        .nodes("children", (0..3).map(axis).collect())
        .text("name", &format!("goal {number}"))
}

/// Returns the joints of an arm, each within the one before: a motor, a sensor, and the link to the next joint.
fn arm(chain: &SerialChain, angles: &[f64; 7]) -> Node {
    let ends = chain.joints().iter().skip(1).map(|joint| joint.origin.position);
    let ends = ends.chain([tip(chain)]);
    let joints: Vec<_> = chain.joints().iter().zip(angles).zip(ends).collect();
    let mut inner: Option<Node> = None;
    for ((joint, angle), end) in joints.into_iter().rev() {
        let turned = joint.origin.then(&Transform::about(joint.axis, *angle));
        let length = end.iter().map(|part| part * part).sum::<f64>().sqrt();
        // The links lie along x.
        let link = cuboid([length.max(THICKNESS), THICKNESS, THICKNESS]);
        let link = placed([length / 2.0, 0.0, 0.0], UPRIGHT, vec![shape(link, [0.2, 0.3, 0.55])]);
        let children = [vec![link], inner.take().into_iter().collect()].concat();
        let solid = Node::new("Solid")
            .numbers("translation", &turned.position)
            .numbers("rotation", &rotation(&turned))
            .nodes("children", children)
            .text("name", &format!("{} link", joint.name));
        let axis = joint.origin.turn(joint.axis);
        let parameters = Node::new("HingeJointParameters")
            .number("position", *angle)
            .numbers("axis", &axis)
            .numbers("anchor", &joint.origin.position);
        let motor = Node::new("RotationalMotor").text("name", &joint.name).number("maxVelocity", 3.0);
        let motor = match joint.range {
            Some([low, high]) => motor.number("minPosition", low).number("maxPosition", high),
            None => motor,
        };
        let sensor = Node::new("PositionSensor").text("name", &format!("{} position", joint.name));
        inner = Some(
            Node::new("HingeJoint")
                .node("jointParameters", parameters)
                .nodes("device", vec![motor, sensor])
                .node("endPoint", solid),
        );
    }
    inner.unwrap_or_else(|| Node::new("Group"))
}

/// Returns where the tip is in the frame of the last joint.
fn tip(chain: &SerialChain) -> [f64; 3] {
    let last = chain.frames(&[]).last().unwrap_or_default();
    last.relative(&chain.forward(&[])).position
}

fn rotation(transform: &Transform) -> [f64; 4] {
    axis_angle(transform.rotation.map(|axis| axis.map(|part| part as f32)))
}
