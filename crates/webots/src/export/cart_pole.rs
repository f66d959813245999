//! Cart-pole: a cart on a rail, pushed by 10 N, with a pole that turns freely.

use super::episode::Episode;
use super::node::Node;
use super::world::{Physics, UPRIGHT, World, cuboid, mass, placed, robot, shape};

const CART_MASS: f64 = 1.0;
const POLE_MASS: f64 = 0.1;
const POLE_LENGTH: f64 = 1.0;
const CART_HEIGHT: f64 = 0.2;

pub(super) fn world(episode: &Episode) -> World {
    let [x, speed, angle, turning] = [0, 1, 2, 3].map(|index| episode.number(index));
    let physics = Physics { step_ms: 20.0, gravity: 9.8 };
    // The view from -y, along y.
    let half_pi = std::f64::consts::FRAC_PI_2;
    World::new(episode, &physics, [0.0, -6.0, 0.8], [0.0, 0.0, 1.0, half_pi])
        .with(robot("cart_pole", vec![rail(), slider(x, speed, angle, turning)]))
}

fn rail() -> Node {
    placed([0.0, 0.0, -0.2], UPRIGHT, vec![shape(cuboid([4.8, 0.05, 0.05]), [0.4, 0.4, 0.4])])
}

fn slider(x: f64, speed: f64, angle: f64, turning: f64) -> Node {
    let motor = Node::new("LinearMotor").text("name", "cart").number("maxForce", 10.0);
    let sensor = Node::new("PositionSensor").text("name", "position");
    let cart = Node::defined("CART", "Solid")
        .numbers("translation", &[x, 0.0, 0.0])
        .nodes(
            "children",
            vec![shape(cuboid([0.4, 0.2, CART_HEIGHT]), [0.2, 0.3, 0.7]), hinge(angle, turning, speed)],
        )
        .text("name", "cart")
        .node("physics", mass(CART_MASS, [0.0; 3], [0.01; 3]))
        .numbers("linearVelocity", &[speed, 0.0, 0.0]);
    Node::new("SliderJoint")
        .node(
            "jointParameters",
            Node::new("JointParameters").number("position", x).numbers("axis", &[1.0, 0.0, 0.0]),
        )
        .nodes("device", vec![motor, sensor])
        .node("endPoint", cart)
}

/// A positive angle falls to the right, along x: a turn about y.
fn hinge(angle: f64, turning: f64, speed: f64) -> Node {
    let half = POLE_LENGTH / 2.0;
    let across = POLE_MASS * POLE_LENGTH * POLE_LENGTH / 12.0;
    let joint = Node::new("HingeJointParameters").number("position", angle).numbers("axis", &[0.0, 1.0, 0.0]);
    let centre = [half * turning * angle.cos() + speed, 0.0, -half * turning * angle.sin()];
    let pole = Node::defined("POLE", "Solid")
        .numbers("translation", &[0.0; 3])
        .numbers("rotation", &[0.0, 1.0, 0.0, angle])
        .nodes(
            "children",
            vec![placed(
                [0.0, 0.0, half],
                UPRIGHT,
                vec![shape(cuboid([0.05, 0.05, POLE_LENGTH]), [0.8, 0.6, 0.3])],
            )],
        )
        .text("name", "pole")
        .node("physics", mass(POLE_MASS, [0.0, 0.0, half], [across, across, 1e-5]))
        .numbers("linearVelocity", &centre)
        .numbers("angularVelocity", &[0.0, turning, 0.0]);
    Node::new("HingeJoint")
        .node("jointParameters", joint)
        .nodes("device", vec![Node::new("PositionSensor").text("name", "angle")])
        .node("endPoint", pole)
}
