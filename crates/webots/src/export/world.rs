//! A world file and the nodes that several worlds have.

use std::collections::BTreeMap;
use std::fmt;

use opendr_engine::data::Image;

use super::WorldFiles;
use super::episode::Episode;
use super::node::Node;

/// First line: the version whose worlds have these nodes; later versions read them too.
const HEADER: &str = "#VRML_SIM R2023b utf8";

/// The rotation by no angle.
pub(super) const UPRIGHT: [f64; 4] = [0.0, 0.0, 1.0, 0.0];

/// A world.
#[derive(Debug)]
pub(super) struct World {
    nodes: Vec<Node>,
    textures: BTreeMap<String, Image>,
}

/// Time step and gravity of a world.
pub(super) struct Physics {
    pub step_ms: f64,
    pub gravity: f64,
}

impl World {
    /// Creates a world with light and a view from `from` along the axis-angle `turned`.
    pub fn new(episode: &Episode, physics: &Physics, from: [f64; 3], turned: [f64; 4]) -> Self {
        let about = format!("{}, seed {}, exported by OpenDR", episode.id, episode.seed);
        let info = Node::new("WorldInfo")
            .text("title", &about)
            .number("basicTimeStep", physics.step_ms)
            .number("gravity", physics.gravity)
            .text("coordinateSystem", "ENU");
        let view = Node::new("Viewpoint").numbers("orientation", &turned).numbers("position", &from);
        let sky = Node::new("Background").words("skyColor", "[ 0.8 0.87 0.95 ]");
        let sun =
            Node::new("DirectionalLight").numbers("direction", &[0.3, 0.4, -1.0]).number("intensity", 2.5);
        Self { nodes: vec![info, view, sky, sun], textures: BTreeMap::new() }
    }

    /// Sets the coefficient of friction of all contacts.
    #[must_use]
    pub fn with_friction(mut self, coefficient: f64) -> Self {
        let contacts = Node::new("ContactProperties").list("coulombFriction", &[coefficient], 1);
        self.nodes[0] = self.nodes[0].clone().nodes("contactProperties", vec![contacts]);
        self
    }

    #[must_use]
    pub fn with(mut self, node: Node) -> Self {
        self.nodes.push(node);
        self
    }

    /// Adds an image whose address in the world is `url`.
    #[must_use]
    pub fn with_texture(mut self, url: String, image: Image) -> Self {
        self.textures.insert(url, image);
        self
    }

    /// Returns the files of the world.
    pub fn into_files(self) -> WorldFiles {
        WorldFiles { world: self.to_string(), textures: self.textures }
    }
}

impl fmt::Display for World {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{HEADER}\n")?;
        self.nodes.iter().try_for_each(|node| node.fmt(f))
    }
}

/// Returns the robot of a world: a supervisor, so that an environment can reset the simulation.
pub(super) fn robot(name: &str, children: Vec<Node>) -> Node {
    Node::defined("ROBOT", "Robot")
        .text("name", name)
        .text("controller", "<extern>")
        .words("supervisor", "TRUE")
        .nodes("children", children)
}

/// Returns a shape of one colour.
pub(super) fn shape(geometry: Node, colour: [f64; 3]) -> Node {
    let appearance = Node::new("PBRAppearance")
        .numbers("baseColor", &colour)
        .number("roughness", 0.8)
        .number("metalness", 0.0);
    Node::new("Shape").node("appearance", appearance).node("geometry", geometry)
}

pub(super) fn cuboid(size: [f64; 3]) -> Node {
    Node::new("Box").numbers("size", &size)
}

/// Returns the same node with a pose.
pub(super) fn placed(translation: [f64; 3], rotation: [f64; 4], children: Vec<Node>) -> Node {
    Node::new("Pose")
        .numbers("translation", &translation)
        .numbers("rotation", &rotation)
        .nodes("children", children)
}

/// Returns the physics of a solid whose moments of inertia about its centre of mass are equal or given.
pub(super) fn mass(mass: f64, centre: [f64; 3], inertia: [f64; 3]) -> Node {
    let centre = format!("[ {} {} {} ]", centre[0], centre[1], centre[2]);
    let inertia = format!("[ {} {} {}, 0 0 0 ]", inertia[0], inertia[1], inertia[2]);
    Node::new("Physics")
        .number("density", -1.0)
        .number("mass", mass)
        .words("centerOfMass", &centre)
        .words("inertiaMatrix", &inertia)
}
