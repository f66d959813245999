//! Operators with attributes, before they are connected.

use super::proto::{AttributeProto, AttributeType, NodeProto};

/// An operator with its attributes, e.g. `Operator::new("Conv").ints("strides", [2, 2])`.
#[derive(Debug, Clone, PartialEq)]
pub struct Operator {
    name: &'static str,
    attributes: Vec<AttributeProto>,
}

impl Operator {
    /// Creates an operator of ONNX's default domain without attributes.
    pub fn new(name: &'static str) -> Self {
        Self { name, attributes: Vec::new() }
    }

    /// Adds an integer attribute.
    #[must_use]
    pub fn int(self, key: &str, value: i64) -> Self {
        self.with(key, AttributeType::Int, |attribute| attribute.i = value)
    }

    /// Adds an attribute with a list of integers.
    #[must_use]
    pub fn ints(self, key: &str, values: impl IntoIterator<Item = i64>) -> Self {
        self.with(key, AttributeType::Ints, |attribute| attribute.ints = values.into_iter().collect())
    }

    /// Adds a float attribute.
    #[must_use]
    pub fn float(self, key: &str, value: f32) -> Self {
        self.with(key, AttributeType::Float, |attribute| attribute.f = value)
    }

    /// Adds a string attribute.
    #[must_use]
    pub fn text(self, key: &str, value: &str) -> Self {
        self.with(key, AttributeType::String, |attribute| attribute.s = value.as_bytes().to_vec())
    }

    /// Converts to a node without inputs and outputs.
    pub(super) fn into_node(self, name: &str) -> NodeProto {
        NodeProto {
            name: name.to_owned(),
            op_type: self.name.to_owned(),
            attribute: self.attributes,
            ..NodeProto::default()
        }
    }

    fn with(mut self, key: &str, kind: AttributeType, set: impl FnOnce(&mut AttributeProto)) -> Self {
        let mut attribute =
            AttributeProto { name: key.to_owned(), r#type: kind as i32, ..AttributeProto::default() };
        set(&mut attribute);
        self.attributes.push(attribute);
        self
    }

    /// Returns ONNX's name of the operator.
    pub fn name(&self) -> &'static str {
        self.name
    }

    /// Returns the attributes in the order they were added.
    pub fn attributes(&self) -> &[AttributeProto] {
        &self.attributes
    }

    /// Returns an integer attribute, if present.
    pub fn get_int(&self, key: &str) -> Option<i64> {
        attribute(&self.attributes, key).map(|attribute| attribute.i)
    }

    /// Returns an attribute with a list of integers, if present.
    pub fn get_ints(&self, key: &str) -> Option<&[i64]> {
        attribute(&self.attributes, key).map(|attribute| attribute.ints.as_slice())
    }
}

fn attribute<'a>(attributes: &'a [AttributeProto], key: &str) -> Option<&'a AttributeProto> {
    attributes.iter().find(|attribute| attribute.name == key)
}

impl NodeProto {
    /// Returns the attribute of that name.
    pub fn find(&self, key: &str) -> Option<&AttributeProto> {
        attribute(&self.attribute, key)
    }

    /// Returns an integer attribute or the default.
    pub fn int_or(&self, key: &str, default: i64) -> i64 {
        self.find(key).map_or(default, |attribute| attribute.i)
    }

    /// Returns an attribute with a list of integers, if present.
    pub fn ints(&self, key: &str) -> Option<&[i64]> {
        self.find(key).map(|attribute| attribute.ints.as_slice())
    }

    /// Sets an attribute with a list of integers, replacing an existing one.
    pub fn set_ints(&mut self, key: &str, values: Vec<i64>) {
        self.attribute.retain(|attribute| attribute.name != key);
        self.attribute.extend(Operator::new("").ints(key, values).attributes);
    }
}
