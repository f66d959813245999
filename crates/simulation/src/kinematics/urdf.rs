//! Reading of the Unified Robot Description Format (wiki.ros.org/urdf/XML).

use opendr_engine::{Error, Result, ResultExt as _};
use roxmltree::{Document, Node};

use super::joint::Joint;
use super::transform::Transform;
use crate::multirotor::{Vector, dot, unit};

/// A joint and the links that it connects.
pub(super) struct Connection {
    pub parent: String,
    pub child: String,
    pub joint: Joint,
    /// Whether the joint can move.
    pub movable: bool,
}

/// Most joints of a description.
const MOST_JOINTS: usize = 1000;

/// Reads all joints of a description.
///
/// # Errors
/// `Format` for text that is no URDF, `Unsupported` for joints that are neither fixed, revolute nor continuous.
pub(super) fn connections(text: &str) -> Result<Vec<Connection>> {
    let document = Document::parse(text).map_err(|error| Error::format(format!("URDF: {error}")))?;
    let robot = document.root_element();
    if !robot.has_tag_name("robot") {
        return Err(Error::format("URDF: the outermost element is not <robot>"));
    }
    let joints = robot.children().filter(|node| node.has_tag_name("joint"));
    if joints.clone().count() > MOST_JOINTS {
        return Err(Error::format(format!("URDF: more than {MOST_JOINTS} joints")));
    }
    joints.map(connection).collect()
}

fn connection(node: Node<'_, '_>) -> Result<Connection> {
    let name = attribute(node, "name")?;
    read(node, name).context(|| format!("URDF: the joint {name:?}"))
}

fn read(node: Node<'_, '_>, name: &str) -> Result<Connection> {
    let link = |tag| attribute(child(node, tag).ok_or_else(|| missing(tag))?, "link").map(str::to_owned);
    let (parent, of) = (link("parent")?, link("child")?);
    let origin = match child(node, "origin") {
        Some(origin) => Transform {
            position: vector(origin, "xyz", [0.0; 3])?,
            ..Transform::from_rpy(vector(origin, "rpy", [0.0; 3])?)
        },
        None => Transform::default(),
    };
    let axis =
        child(node, "axis").map_or(Ok([1.0, 0.0, 0.0]), |axis| vector(axis, "xyz", [1.0, 0.0, 0.0]))?;
    if dot(axis, axis) < 1e-12 {
        return Err(Error::format("its axis has no direction"));
    }
    let mut range = None;
    let movable = match attribute(node, "type")? {
        "fixed" => false,
        "continuous" => true,
        "revolute" => {
            let limit = child(node, "limit").ok_or_else(|| missing("limit"))?;
            let [low, high] = [number(limit, "lower")?, number(limit, "upper")?];
            if low > high {
                return Err(Error::format(format!("its limits {low} and {high} are exchanged")));
            }
            range = Some([low, high]);
            true
        }
        other => {
            let message = format!("its type {other:?}; only fixed, revolute and continuous are supported");
            return Err(Error::unsupported(message));
        }
    };
    let joint = Joint { name: name.to_owned(), origin, axis: unit(axis), range };
    Ok(Connection { parent, child: of, joint, movable })
}

fn child<'a>(node: Node<'a, 'a>, tag: &str) -> Option<Node<'a, 'a>> {
    node.children().find(|child| child.has_tag_name(tag))
}

fn attribute<'a>(node: Node<'a, '_>, name: &str) -> Result<&'a str> {
    node.attribute(name)
        .ok_or_else(|| Error::format(format!("<{}> without the attribute {name:?}", node.tag_name().name())))
}

fn missing(tag: &str) -> Error {
    Error::format(format!("no <{tag}>"))
}

fn number(node: Node<'_, '_>, name: &str) -> Result<f64> {
    node.attribute(name).map_or(Ok(0.0), finite)
}

fn finite(text: &str) -> Result<f64> {
    let number = text.parse().ok().filter(|number: &f64| number.is_finite());
    number.ok_or_else(|| Error::format(format!("{text:?} is not a number")))
}

fn vector(node: Node<'_, '_>, name: &str, default: Vector) -> Result<Vector> {
    let Some(text) = node.attribute(name) else { return Ok(default) };
    let parts = text.split_whitespace().map(finite).collect::<Result<Vec<_>>>()?;
    parts.try_into().map_err(|_| Error::format(format!("{text:?} has not three numbers")))
}
