//! The planar worlds: a table with bodies, and a gantry whose motors are the actions.

use opendr_engine::Result;
use opendr_simulation::planar_grasp::{GRASP_HEIGHT, MAX_WIDTH, PlanarGrasp};
use opendr_simulation::planar_peg::{self, PlanarPeg};
use opendr_simulation::planar_push::{self, PlanarPush, PlanarPushParams};
use opendr_simulation::solids::{Prism, Solid};

use super::episode::Episode;
use super::gantry::{Drive, gantry};
use super::node::Node;
use super::rotation::axis_angle;
use super::solid::{prisms, standing};
use super::world::{Physics, UPRIGHT, World, cuboid, placed, shape};

/// Height of bodies, m.
const HEIGHT: f64 = 0.03;
const TABLE: [f64; 3] = [0.75, 0.72, 0.66];
const STEEL: [f64; 3] = [0.35, 0.38, 0.45];
const WOOD: [f64; 3] = [0.75, 0.52, 0.3];
const RED: [f64; 3] = [0.75, 0.3, 0.25];
const GREY: [f64; 3] = [0.55, 0.55, 0.58];
const X: [f64; 3] = [1.0, 0.0, 0.0];
const Y: [f64; 3] = [0.0, 1.0, 0.0];
const Z: [f64; 3] = [0.0, 0.0, 1.0];
/// Forces of the gantry and of the fingers, N.
const FORCE: f64 = 30.0;
const GRIP: f64 = 6.0;

/// `PlanarPush-v1`: motors `x` and `y` move the pusher.
pub(super) fn push(episode: &Episode) -> Result<World> {
    let environment = episode.environment::<PlanarPush>()?;
    let mut world = table(episode, episode.params::<PlanarPushParams>()?.table_friction);
    let solids = environment.solids();
    let [pusher, tee] = &solids[..] else { return Ok(world) };
    let (hand, bounds) = prisms(pusher, HEIGHT, STEEL, |_| true);
    let drives = plane(pusher, planar_push::MAX_SPEED);
    world = world.with(standing("tee", tee, HEIGHT, RED));
    Ok(world.with(gantry("pusher", &drives, hand, Some(bounds), Vec::new())))
}

/// `PlanarPeg-v1`: motors `x`, `y` and `turn` move the gripper, `left finger` and `right finger` open it.
pub(super) fn peg(episode: &Episode) -> Result<World> {
    let environment = episode.environment::<PlanarPeg>()?;
    let mut world = table(episode, 0.3);
    let solids = environment.solids();
    let [gripper, peg, post, wall] = &solids[..] else { return Ok(world) };
    let [fast, turn, open] = planar_peg::MAX_SPEEDS;
    for (name, solid, colour) in [("peg", peg, WOOD), ("post", post, GREY), ("wall", wall, GREY)] {
        world = world.with(standing(name, solid, HEIGHT, colour));
    }
    let (mut hand, palm) = prisms(gripper, HEIGHT, STEEL, |prism| prism.slides == 0.0);
    hand.extend(fingers(gripper, open));
    let mut drives = plane(gripper, fast);
    drives.push(Drive::turning("turn", gripper.pose[2], turn, 2.0));
    Ok(world.with(gantry("gripper", &drives, hand, Some(palm), Vec::new())))
}

/// `PlanarGrasp-v1`: camera and range finder over the table, and a gripper that motors move, lift and turn; it waits at the side.
pub(super) fn grasp(episode: &Episode) -> Result<World> {
    let environment = episode.environment::<PlanarGrasp>()?;
    let camera = environment.camera();
    let world = table(episode, 0.4);
    let object = standing("object", &environment.solid()?, GRASP_HEIGHT, WOOD);
    let finger = |side: f64| Prism {
        corners: [[-0.005, -0.01], [0.005, -0.01], [0.005, 0.01], [-0.005, 0.01]]
            .map(|[x, y]: [f64; 2]| [x + side * 0.005, y])
            .to_vec(),
        radius: 0.0,
        slides: side,
    };
    let gripper = Solid {
        pose: [0.3, 0.0, 0.0],
        slide: MAX_WIDTH / 2.0,
        mass: Some(1.0),
        inertia: 1e-3,
        prisms: vec![finger(1.0), finger(-1.0)],
    };
    let mut drives = plane(&gripper, 0.2);
    drives.extend([Drive::sliding("lift", Z, 0.1, 0.2, FORCE), Drive::turning("turn", 0.0, 1.5, 2.0)]);
    let size = camera.size() as f64;
    // A camera of Webots looks along its x-axis; this one looks down, with the y-axis of the table upwards in its image.
    let down = axis_angle([[0.0, 0.0, -1.0], [-1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]);
    let eye = |node: Node| {
        node.numbers("translation", &[0.0, 0.0, camera.height()])
            .numbers("rotation", &down)
            .number("fieldOfView", camera.field_of_view())
            .number("width", size)
            .number("height", size)
    };
    let eyes = vec![
        eye(Node::new("Camera").text("name", "image")),
        eye(Node::new("RangeFinder").text("name", "depth").number("minRange", 0.01).number("maxRange", 2.0)),
    ];
    let hand = fingers(&gripper, 0.05);
    Ok(world.with(object).with(gantry("gripper", &drives, hand, None, eyes)))
}

/// Returns motors along x and y for a solid.
fn plane(solid: &Solid, speed: f64) -> Vec<Drive> {
    let [x, y, _] = solid.pose;
    vec![Drive::sliding("x", X, x, speed, FORCE), Drive::sliding("y", Y, y, speed, FORCE)]
}

/// Returns the joints of the prisms that slide.
fn fingers(gripper: &Solid, speed: f64) -> Vec<Node> {
    let sides = [("right finger", 1.0), ("left finger", -1.0)];
    let joint = |(name, side): (&'static str, f64)| {
        let (shapes, bounds) = prisms(gripper, HEIGHT, STEEL, |prism| prism.slides * side > 0.0);
        Drive::sliding(name, [side, 0.0, 0.0], gripper.slide, speed, GRIP).joint(shapes, Some(bounds))
    };
    sides.into_iter().map(joint).collect()
}

/// Returns a world with a table whose top is at height 0, and the coefficient of its friction.
fn table(episode: &Episode, friction: f64) -> World {
    let physics = Physics { step_ms: 10.0, gravity: 9.81 };
    let top = cuboid([0.9, 0.9, 0.04]);
    let below = |node| placed([0.0, 0.0, -0.02], UPRIGHT, vec![node]);
    let node = Node::new("Solid")
        .nodes("children", vec![below(shape(top.clone(), TABLE))])
        .text("name", "table")
        .node("boundingObject", below(top));
    World::new(episode, &physics, [-0.6, 0.0, 0.9], [0.0, 1.0, 0.0, 0.95]).with_friction(friction).with(node)
}
