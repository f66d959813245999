//! Solids of planar worlds as nodes.

use opendr_simulation::solids::{Prism, Solid};

use super::node::Node;
use super::world::{UPRIGHT, mass, placed, shape};

/// Returns prisms of a `height`, from the origin upwards, and their bounding object. `keep` chooses the prisms.
pub(super) fn prisms(
    solid: &Solid,
    height: f64,
    colour: [f64; 3],
    keep: impl Fn(&Prism) -> bool,
) -> (Vec<Node>, Node) {
    let chosen = solid.prisms.iter().filter(|prism| keep(prism));
    let parts = chosen.map(|prism| {
        let (geometry, centre) = extruded(prism, height);
        let bounds = placed(centre, UPRIGHT, vec![geometry.clone()]);
        (placed(centre, UPRIGHT, vec![shape(geometry, colour)]), bounds)
    });
    let (shapes, bounds) = parts.unzip();
    (shapes, Node::new("Group").nodes("children", bounds))
}

/// Returns the geometry of a prism, and where its centre is.
fn extruded(prism: &Prism, height: f64) -> (Node, [f64; 3]) {
    if let [[x, y]] = prism.corners[..] {
        let cylinder = Node::new("Cylinder")
            .number("radius", prism.radius)
            .number("height", height)
            .number("subdivision", 32.0);
        return (cylinder, [x, y, height / 2.0]);
    }
    let sides = prism.corners.len();
    let level = |z: f64| prism.corners.iter().flat_map(move |[x, y]| [*x, *y, z]);
    let points: Vec<_> = level(0.0).chain(level(height)).collect();
    let index = |corner: usize| (corner % sides) as f64;
    let bottom = (0..sides).rev().map(index).chain([-1.0]);
    let top = (0..sides).map(|corner| index(corner) + sides as f64).chain([-1.0]);
    let walls = (0..sides).flat_map(|corner| {
        let (left, right) = (index(corner), index(corner + 1));
        [left, right, right + sides as f64, left + sides as f64, -1.0]
    });
    let faces: Vec<_> = bottom.chain(top).chain(walls).collect();
    let coordinates = Node::new("Coordinate").list("point", &points, 3);
    let mesh = Node::new("IndexedFaceSet").node("coord", coordinates).list("coordIndex", &faces, faces.len());
    (mesh, [0.0; 3])
}

/// Returns a solid that stands on the table and is found by `name`; with physics if it can move.
pub(super) fn standing(name: &str, solid: &Solid, height: f64, colour: [f64; 3]) -> Node {
    let [x, y, angle] = solid.pose;
    let (shapes, bounds) = prisms(solid, height, colour, |_| true);
    let node = Node::defined(&name.to_uppercase(), "Solid")
        .numbers("translation", &[x, y, 0.0])
        .numbers("rotation", &[0.0, 0.0, 1.0, angle])
        .nodes("children", shapes)
        .text("name", name)
        .node("boundingObject", bounds);
    let Some(kilograms) = solid.mass else { return node };
    // The moments of inertia about axes in the table: a plate's are half of that about its normal.
    let across = solid.inertia / 2.0 + kilograms * height * height / 12.0;
    node.node("physics", mass(kilograms, [0.0, 0.0, height / 2.0], [across, across, solid.inertia]))
}
