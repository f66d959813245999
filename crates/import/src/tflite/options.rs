//! Parameters of operators.

use opendr_engine::{Error, Result};

use super::flatbuffer::Table;
use super::model::Node;
use crate::tensorflow::Attribute;

/// The parameters of an operator; defaults where it has none.
pub struct Options<'a, 'f>(Option<Table<'a, 'f>>);

impl<'a, 'f> Options<'a, 'f> {
    /// Returns the parameters of a node.
    pub fn of(node: &Node<'a, 'f>) -> Self {
        Self(node.options)
    }

    /// Returns an enumeration or boolean.
    pub fn byte(&self, index: usize) -> Result<u8> {
        self.0.map_or(Ok(0), |table| table.byte(index))
    }

    /// Returns an integer.
    pub fn int(&self, index: usize, default: i32) -> Result<i32> {
        self.0.map_or(Ok(default), |table| table.int(index, default))
    }

    /// Returns an integer as an attribute.
    pub fn number(&self, index: usize) -> Result<Attribute> {
        Ok(Attribute::Int(self.int(index, 0)?.into()))
    }

    /// Returns a boolean as an attribute.
    pub fn flag(&self, index: usize) -> Result<Attribute> {
        Ok(Attribute::Flag(self.byte(index)? != 0))
    }

    /// Returns a float.
    pub fn float(&self, index: usize, default: f32) -> Result<f32> {
        self.0.map_or(Ok(default), |table| table.float(index, default))
    }

    /// Returns a list of integers.
    pub fn ints(&self, index: usize) -> Result<Vec<i64>> {
        let ints = self.0.map_or(Ok(Vec::new()), |table| table.ints(index))?;
        Ok(ints.into_iter().map(i64::from).collect())
    }

    /// Returns the fused activation.
    ///
    /// # Errors
    /// `Unsupported` for an unknown one.
    pub fn activation(&self, index: usize) -> Result<Option<&'static str>> {
        match self.byte(index)? {
            0 => Ok(None),
            1 => Ok(Some("Relu")),
            2 => Ok(Some("ReluN1To1")),
            3 => Ok(Some("Relu6")),
            4 => Ok(Some("Tanh")),
            other => Err(Error::unsupported(format!("unsupported activation {other}"))),
        }
    }
}
