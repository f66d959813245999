//! A link that hangs on a hinge about the y axis.

use super::node::Node;
use super::world::{UPRIGHT, cuboid, mass, placed, shape};

const LENGTH: f64 = 1.0;
const MASS: f64 = 1.0;

/// A link of 1 m and 1 kg; at angle 0 it hangs down from its joint.
pub(super) struct Link {
    pub name: &'static str,
    /// Position of the joint in the frame of its parent.
    pub anchor: [f64; 3],
    pub angle: f64,
    /// Velocity of the centre of mass and angular velocity about y, in the world.
    pub velocity: [f64; 3],
    pub turning: f64,
    /// Moment of inertia about the centre of mass, across the link.
    pub inertia: f64,
    /// Torque of its motor; none if it turns freely.
    pub torque: Option<f64>,
    pub children: Vec<Node>,
}

impl Link {
    /// Returns the joint with the link.
    pub fn joint(self) -> Node {
        let Self { name, anchor, angle, inertia, .. } = self;
        let half = LENGTH / 2.0;
        let body = shape(cuboid([0.08, 0.08, LENGTH]), [0.7, 0.3, 0.3]);
        let children = [vec![placed([0.0, 0.0, -half], UPRIGHT, vec![body])], self.children].concat();
        let sensor = Node::new("PositionSensor").text("name", &format!("{name} angle"));
        let motor = |torque: f64| {
            Node::new("RotationalMotor")
                .text("name", &format!("{name} motor"))
                .number("maxTorque", torque)
                .number("maxVelocity", 30.0)
        };
        let devices = self.torque.map(motor).into_iter().chain([sensor]).collect();
        let solid = Node::defined(&name.to_uppercase(), "Solid")
            .numbers("translation", &anchor)
            .numbers("rotation", &[0.0, 1.0, 0.0, angle])
            .nodes("children", children)
            .text("name", name)
            .node("physics", mass(MASS, [0.0, 0.0, -half], [inertia, inertia, 1e-3]))
            .numbers("linearVelocity", &self.velocity)
            .numbers("angularVelocity", &[0.0, self.turning, 0.0]);
        let joint = Node::new("HingeJointParameters")
            .number("position", angle)
            .numbers("axis", &[0.0, 1.0, 0.0])
            .numbers("anchor", &anchor);
        Node::new("HingeJoint")
            .node("jointParameters", joint)
            .nodes("device", devices)
            .node("endPoint", solid)
    }
}
