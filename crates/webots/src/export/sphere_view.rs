//! Active perception: a subject with textures in its enclosure, in its own frame, and a camera that a controller places.

use opendr_engine::Result;
use opendr_simulation::raycast::{Body, Shape};
use opendr_simulation::sphere_view::{
    OCCLUDER, SIDE, SphereView, SphereViewParams, SphereWorld, Subject, TexturedMesh,
};

use super::episode::Episode;
use super::node::Node;
use super::rotation::axis_angle;
use super::world::{Physics, World, cuboid, placed, robot, shape};

pub(super) fn world(episode: &Episode, subject: Subject) -> Result<World> {
    let mut environment = SphereView::new(subject, &episode.params::<SphereViewParams>()?)?;
    episode.reset(&mut environment)?;
    let view = environment.world();
    let physics = Physics { step_ms: 50.0, gravity: 0.0 };
    let mut world = World::new(episode, &physics, [5.0, -3.5, 3.5], [-0.32, 0.23, 0.92, 2.4]);
    let mut parts = Vec::new();
    for (number, (body, mesh)) in view.asset().textured_parts()?.into_iter().enumerate() {
        let url = format!("textures/{}-seed-{}-{number}.png", episode.id, episode.seed);
        parts.push(at_pose(body, textured(&mesh, &url)));
        world = world.with_texture(url, mesh.texture);
    }
    let parts = Node::defined("SUBJECT", "Solid").nodes("children", parts).text("name", "subject");
    let occluders = view.occluders().iter().filter_map(|body| Some(at_pose(body, occluder(body.shape())?)));
    let occluders = Node::new("Solid").nodes("children", occluders.collect()).text("name", "occluders");
    Ok(world.with(parts).with(occluders).with(camera(view)))
}

fn at_pose(body: &Body, shape: Node) -> Node {
    placed(body.position().map(f64::from), axis_angle(body.axes()), vec![shape])
}

fn textured(mesh: &TexturedMesh, url: &str) -> Node {
    let texture = Node::new("ImageTexture").list_of_texts("url", &[url]).words("repeatS", "FALSE");
    let appearance = Node::new("PBRAppearance")
        .node("baseColorMap", texture.words("repeatT", "FALSE"))
        .number("roughness", 1.0)
        .number("metalness", 0.0);
    let numbers = |rows: &[f32]| rows.iter().copied().map(f64::from).collect::<Vec<_>>();
    let face = |[a, b, c]: &[u32; 3]| [f64::from(*a), f64::from(*b), f64::from(*c), -1.0];
    let faces: Vec<_> = mesh.faces.iter().flat_map(face).collect();
    let points = Node::new("Coordinate").list("point", &numbers(mesh.vertices.as_flattened()), 3);
    let places = mesh.texture_coordinates.as_flattened();
    let geometry = Node::new("IndexedFaceSet")
        .node("coord", points)
        .node("texCoord", Node::new("TextureCoordinate").list("point", &numbers(places), 2))
        .list("coordIndex", &faces, 4)
        .list("texCoordIndex", &faces, 4)
        .number("creaseAngle", 1.5);
    Node::new("Shape").node("appearance", appearance).node("geometry", geometry)
}

/// Returns a panel or the pole.
fn occluder(body: &Shape) -> Option<Node> {
    let geometry = match body {
        Shape::Box { half } => cuboid(half.map(|part| 2.0 * f64::from(part))),
        Shape::Cylinder { radius, half_height } => Node::new("Cylinder")
            .number("radius", f64::from(*radius))
            .number("height", 2.0 * f64::from(*half_height)),
        _ => return None,
    };
    Some(shape(geometry, OCCLUDER.map(f64::from)))
}

/// Returns the robot: a camera at the first pose of the episode.
fn camera(view: &SphereWorld) -> Node {
    let pose = view.camera_pose();
    let camera = Node::new("Camera")
        .text("name", "camera")
        .number("fieldOfView", view.field_of_view())
        .number("width", SIDE as f64)
        .number("height", SIDE as f64);
    let devices = [camera, Node::new("GPS").text("name", "position")];
    robot("camera", devices.into())
        .numbers("translation", &pose.position.map(f64::from))
        .numbers("rotation", &axis_angle(pose.axes))
}
