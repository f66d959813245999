//! Parameters of TensorFlow operators.

use std::collections::BTreeMap;

use opendr_onnx::ElementType;

/// A parameter.
#[derive(Debug, Clone, PartialEq)]
pub enum Attribute {
    Int(i64),
    Float(f32),
    Flag(bool),
    Text(String),
    Ints(Vec<i64>),
    Texts(Vec<String>),
    Kind(ElementType),
    /// Dimensions, -1 where open.
    Shape(Vec<i64>),
}

/// Parameters by name. Missing ones have TensorFlow's defaults, so every reader has a default.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Attributes(BTreeMap<String, Attribute>);

impl Attributes {
    /// Sets a parameter.
    #[must_use]
    pub fn with(mut self, key: &str, value: Attribute) -> Self {
        self.0.insert(key.to_owned(), value);
        self
    }

    /// Returns an integer.
    pub fn int(&self, key: &str) -> Option<i64> {
        match self.0.get(key)? {
            Attribute::Int(value) => Some(*value),
            _ => None,
        }
    }

    /// Returns a float.
    pub fn float(&self, key: &str) -> Option<f32> {
        match self.0.get(key)? {
            Attribute::Float(value) => Some(*value),
            _ => None,
        }
    }

    /// Returns a boolean; false when missing.
    pub fn flag(&self, key: &str) -> bool {
        matches!(self.0.get(key), Some(Attribute::Flag(true)))
    }

    /// Returns a string.
    pub fn text(&self, key: &str) -> Option<&str> {
        match self.0.get(key)? {
            Attribute::Text(text) => Some(text),
            _ => None,
        }
    }

    /// Returns a list of integers; empty when missing.
    pub fn ints(&self, key: &str) -> &[i64] {
        match self.0.get(key) {
            Some(Attribute::Ints(values)) => values,
            _ => &[],
        }
    }

    /// Returns a list of strings; empty when missing.
    pub fn texts(&self, key: &str) -> &[String] {
        match self.0.get(key) {
            Some(Attribute::Texts(values)) => values,
            _ => &[],
        }
    }

    /// Returns an element type; `None` for a type that the graphs do not support (strings, complex numbers).
    pub fn kind(&self, key: &str) -> Option<ElementType> {
        match self.0.get(key)? {
            Attribute::Kind(kind) => Some(*kind),
            _ => None,
        }
    }

    /// Returns dimensions, -1 where open; `None` when the rank is open.
    pub fn shape(&self, key: &str) -> Option<&[i64]> {
        match self.0.get(key)? {
            Attribute::Shape(dims) => Some(dims),
            _ => None,
        }
    }
}

impl FromIterator<(String, Attribute)> for Attributes {
    fn from_iter<I: IntoIterator<Item = (String, Attribute)>>(attributes: I) -> Self {
        Self(attributes.into_iter().collect())
    }
}
