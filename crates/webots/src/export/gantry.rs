//! A gripper or a pusher that a gantry moves over a table.

use super::node::Node;
use super::world::{mass, robot};

/// A motor at a joint of the gantry.
pub(super) struct Drive {
    pub name: &'static str,
    pub axis: [f64; 3],
    /// Position at the start, m or rad.
    pub position: f64,
    /// Fastest motion, m/s or rad/s, and largest force, N or N m.
    pub speed: f64,
    pub force: f64,
    pub turns: bool,
}

impl Drive {
    /// Returns a motor that slides along an axis.
    pub fn sliding(name: &'static str, axis: [f64; 3], position: f64, speed: f64, force: f64) -> Self {
        Self { name, axis, position, speed, force, turns: false }
    }

    /// Returns a motor that turns about the vertical.
    pub fn turning(name: &'static str, position: f64, speed: f64, force: f64) -> Self {
        Self { name, axis: [0.0, 0.0, 1.0], position, speed, force, turns: true }
    }

    /// Returns the joint with this motor and a sensor, and at its end a solid with `children`.
    pub fn joint(&self, children: Vec<Node>, bounds: Option<Node>) -> Node {
        let (joint, params, motor, limits) = match self.turns {
            true => ("HingeJoint", "HingeJointParameters", "RotationalMotor", ["maxTorque", "maxVelocity"]),
            false => ("SliderJoint", "JointParameters", "LinearMotor", ["maxForce", "maxVelocity"]),
        };
        let params = Node::new(params).number("position", self.position).numbers("axis", &self.axis);
        let motor = Node::new(motor)
            .text("name", self.name)
            .number(limits[0], self.force)
            .number(limits[1], self.speed);
        let sensor = Node::new("PositionSensor").text("name", &format!("{} position", self.name));
        let solid = Node::new("Solid");
        let solid = match self.turns {
            true => solid.numbers("rotation", &[0.0, 0.0, 1.0, self.position]),
            false => solid.numbers("translation", &self.axis.map(|part| part * self.position)),
        };
        let solid = solid
            .nodes("children", children)
            .text("name", &format!("{} slide", self.name))
            .node("physics", mass(0.3, [0.0; 3], [1e-3; 3]));
        let solid = match bounds {
            Some(bounds) => solid.node("boundingObject", bounds),
            None => solid,
        };
        Node::new(joint)
            .node("jointParameters", params)
            .nodes("device", vec![motor, sensor])
            .node("endPoint", solid)
    }
}

/// Returns the robot whose `drives` move, one upon the other, what is at the end of the last of them.
pub(super) fn gantry(
    name: &str,
    drives: &[Drive],
    mut hand: Vec<Node>,
    mut bounds: Option<Node>,
    beside: Vec<Node>,
) -> Node {
    for drive in drives.iter().rev() {
        hand = vec![drive.joint(hand, bounds.take())];
    }
    hand.extend(beside);
    robot(name, hand)
}
