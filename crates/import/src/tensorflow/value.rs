//! Tensors of a TensorFlow graph during conversion.

use super::layout::Order;
use opendr_onnx::{Array, Dim, ElementType, GraphTensor};

/// A tensor of a TensorFlow graph: the ONNX tensor and its storage order.
#[derive(Debug, Clone)]
pub struct Value {
    /// The ONNX tensor.
    pub wire: GraphTensor,
    /// TensorFlow's axes in stored order. Constants are always in TensorFlow's order.
    pub order: Order,
}

impl Value {
    /// Creates a tensor stored in the given order; the ranks must match.
    pub fn new(wire: GraphTensor, order: Order) -> Self {
        Self { wire, order }
    }

    /// Creates a tensor stored in TensorFlow's order.
    pub fn plain(wire: GraphTensor) -> Self {
        let order = Order::plain(wire.rank());
        Self { wire, order }
    }

    /// Returns TensorFlow's dimensions.
    pub fn dims(&self) -> Vec<Dim> {
        self.order.logical(self.wire.dims())
    }

    /// Returns TensorFlow's dimensions, if all are known.
    pub fn known_dims(&self) -> Option<Vec<usize>> {
        self.dims().into_iter().collect()
    }

    /// Returns the number of axes.
    pub fn rank(&self) -> usize {
        self.wire.rank()
    }

    /// Returns the element type.
    pub fn kind(&self) -> ElementType {
        self.wire.kind()
    }

    /// Returns the elements, if all are known.
    pub fn array(&self) -> Option<&Array> {
        self.wire.array()
    }
}
