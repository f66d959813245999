//! The quadrotor that tracks a reference. Its plant is that of the environment, so a controller places it.

use opendr_engine::Result;
use opendr_simulation::quad_track::QuadTrack;

use super::episode::Episode;
use super::node::Node;
use super::world::{Physics, UPRIGHT, World, cuboid, robot, shape};

pub(super) fn world(episode: &Episode) -> Result<World> {
    let environment = episode.environment::<QuadTrack>()?;
    let position = environment.position().unwrap_or_default();
    let reference = environment.reference().unwrap_or_default();
    let arm = |size: [f64; 3]| shape(cuboid(size), [0.2, 0.2, 0.25]);
    let body = vec![
        arm([0.5, 0.04, 0.04]),
        arm([0.04, 0.5, 0.04]),
        Node::new("GPS").text("name", "position"),
        Node::new("InertialUnit").text("name", "orientation"),
        Node::new("Gyro").text("name", "gyro"),
    ];
    let robot = robot("quadrotor", body).numbers("translation", &position).numbers("rotation", &UPRIGHT);
    let marker = Node::defined("REFERENCE", "Solid")
        .numbers("translation", &reference)
        .nodes("children", vec![shape(Node::new("Sphere").number("radius", 0.05), [0.9, 0.2, 0.2])])
        .text("name", "reference");
    let physics = Physics { step_ms: 10.0, gravity: 9.81 };
    Ok(World::new(episode, &physics, [-8.0, 0.0, 4.0], [0.0, 1.0, 0.0, 0.3]).with(marker).with(robot))
}
