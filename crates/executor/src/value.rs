//! Values of a plan: element type, shape, and where the elements come from.

use std::sync::Arc;

use crate::constant::Constant;
use crate::tensor::Kind;

/// Order of the dimensions in memory.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Layout {
    /// As the shape states.
    Plain,
    /// The second dimension of the shape comes last.
    ChannelsLast,
}

/// Index of a value of a plan.
pub(crate) type Id = usize;

#[derive(Debug, Clone)]
pub(crate) enum Source {
    Constant(Arc<Constant>),
    Input(usize),
    /// A buffer and an offset in it.
    Buffer(usize, usize),
}

#[derive(Debug, Clone)]
pub(crate) struct Value {
    pub(crate) kind: Kind,
    pub(crate) shape: Vec<usize>,
    pub(crate) layout: Layout,
    pub(crate) source: Source,
    /// The same elements in the other layout.
    pub(crate) other: Option<Id>,
    /// The value with channels last whose elements these are, in the order of its shape.
    pub(crate) reshaped: Option<Id>,
}

impl Value {
    /// Returns the dimensions in the order of memory.
    pub(crate) fn physical(&self) -> Vec<usize> {
        match self.layout {
            Layout::Plain => self.shape.clone(),
            Layout::ChannelsLast => channels_to_end(&self.shape),
        }
    }
}

pub(crate) fn channels_to_end(shape: &[usize]) -> Vec<usize> {
    let mut dims = shape.to_vec();
    if dims.len() > 2 {
        dims[1..].rotate_left(1);
    }
    dims
}
