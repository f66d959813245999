//! A tensor of TensorFlow's graph, standing for one of the ONNX graph.

use super::layout::Order;
use opendr_onnx::{Array, Dim, Kind, Wire};

/// A tensor of TensorFlow's graph: the ONNX tensor and the order in which its axes are stored there.
#[derive(Debug, Clone)]
pub struct Value {
    /// The ONNX tensor.
    pub wire: Wire,
    /// TensorFlow's axes in the order stored. Constants are always plain.
    pub order: Order,
}

impl Value {
    /// A tensor stored in the order given; the ranks agree.
    pub fn new(wire: Wire, order: Order) -> Self {
        Self { wire, order }
    }

    /// A tensor stored as TensorFlow names its axes.
    pub fn plain(wire: Wire) -> Self {
        let order = Order::plain(wire.rank());
        Self { wire, order }
    }

    /// TensorFlow's dimensions.
    pub fn dims(&self) -> Vec<Dim> {
        self.order.logical(self.wire.dims())
    }

    /// TensorFlow's dimensions, if all are known.
    pub fn known_dims(&self) -> Option<Vec<usize>> {
        self.dims().into_iter().collect()
    }

    /// Number of axes.
    pub fn rank(&self) -> usize {
        self.wire.rank()
    }

    /// Element type.
    pub fn kind(&self) -> Kind {
        self.wire.kind()
    }

    /// All elements, if they are known.
    pub fn array(&self) -> Option<&Array> {
        self.wire.array()
    }
}
