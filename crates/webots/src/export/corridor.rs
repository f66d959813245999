//! The corridor: obstacles, walls and a drone with a depth camera, which a controller places.

use opendr_engine::Result;
use opendr_simulation::raycast::{Body, Shape};
use opendr_simulation::uav_corridor::{RANGE, SIDE, UavDepthCorridor};

use super::episode::Episode;
use super::node::Node;
use super::rotation::axis_angle;
use super::world::{Physics, World, cuboid, robot, shape};

/// Radius of the drone and height of its camera above its centre, in m.
const DRONE: f64 = 0.25;
const CAMERA_HEIGHT: f64 = 0.1;
/// Colours by label: ground, wall, cylinder, box, sphere.
const COLOURS: [[f64; 3]; 5] =
    [[0.45, 0.5, 0.4], [0.7, 0.7, 0.7], [0.3, 0.4, 0.8], [0.8, 0.5, 0.2], [0.7, 0.25, 0.3]];

pub(super) fn world(episode: &Episode) -> Result<World> {
    let environment = episode.environment::<UavDepthCorridor>()?;
    let pose = environment.pose();
    let position = pose.position.map(f64::from);
    let robot =
        robot("drone", drone()).numbers("translation", &position).numbers("rotation", &axis_angle(pose.axes));
    let physics = Physics { step_ms: 32.0, gravity: 9.81 };
    let mut world = World::new(episode, &physics, [-22.0, 0.0, 10.0], [0.0, 1.0, 0.0, 0.4]);
    for (number, body) in environment.world().scene().bodies().iter().enumerate() {
        if let Some(solid) = solid(number, body) {
            world = world.with(solid);
        }
    }
    Ok(world.with(robot))
}

/// Returns a body as a solid without physics; none for shapes that no corridor has.
fn solid(number: usize, body: &Body) -> Option<Node> {
    let geometry = match body.shape() {
        Shape::Sphere { radius } => {
            Node::new("Sphere").number("radius", (*radius).into()).number("subdivision", 4.0)
        }
        Shape::Box { half } => cuboid(half.map(|half| 2.0 * f64::from(half))),
        Shape::Cylinder { radius, half_height } => Node::new("Cylinder")
            .number("radius", (*radius).into())
            .number("height", 2.0 * f64::from(*half_height))
            .number("subdivision", 48.0),
        // A plane would be endless; the drone's range is 15 m.
        Shape::HalfSpace => Node::new("Plane").numbers("size", &[120.0, 120.0]),
        Shape::HeightField(_) | Shape::Mesh(_) => return None,
    };
    let colour = COLOURS[usize::from(body.label()).min(COLOURS.len() - 1)];
    let node = Node::new("Solid")
        .numbers("translation", &body.position().map(f64::from))
        .numbers("rotation", &axis_angle(body.axes()))
        .nodes("children", vec![shape(geometry.clone(), colour)])
        .text("name", &format!("body {number}"));
    Some(node.node("boundingObject", geometry))
}

fn drone() -> Vec<Node> {
    let camera = Node::new("RangeFinder")
        .numbers("translation", &[0.0, 0.0, CAMERA_HEIGHT])
        .text("name", "depth")
        .number("fieldOfView", std::f64::consts::FRAC_PI_4)
        .number("width", SIDE as f64)
        .number("height", SIDE as f64)
        .number("minRange", 0.01)
        .number("maxRange", RANGE.into());
    vec![
        // Below the camera, which would see it.
        Node::new("Pose").numbers("translation", &[0.0, 0.0, -CAMERA_HEIGHT]).nodes(
            "children",
            vec![shape(
                Node::new("Cylinder").number("radius", DRONE).number("height", 0.1),
                [0.15, 0.15, 0.15],
            )],
        ),
        camera,
        Node::new("GPS").text("name", "position"),
        Node::new("InertialUnit").text("name", "orientation"),
    ]
}
