//! Helpers of all lowerings: writing of nodes, and conversion of tensors to an order.

use std::collections::HashMap;

use opendr_engine::{Error, Result};

use super::call::Call;
use super::layout::Order;
use super::value::Value;
use opendr_onnx::{Builder, Dim, ElementType, GraphTensor, Operator};

/// Maximum number of axes, above that of real tensors; a hostile file could double them with every operator.
pub const MAX_RANK: usize = 32;

/// The graph under construction, with properties of its tensors.
#[derive(Default)]
pub struct Lowering {
    /// The ONNX graph.
    pub graph: Builder,
    /// Tensors that are a flattening of another one against its stored order, see [`Lowering::note_flattened`].
    flattened: HashMap<String, Value>,
}

impl Lowering {
    /// Adds an operator with one output and returns the output, stored in `order`. `dims` are TensorFlow's.
    ///
    /// # Errors
    /// `Format` when the graph exceeds the maximum number of nodes, or the output has more than [`MAX_RANK`] axes.
    pub fn emit(
        &mut self,
        call: &Call,
        operator: Operator,
        inputs: &[&GraphTensor],
        kind: ElementType,
        dims: &[Dim],
        order: Order,
    ) -> Result<Value> {
        if dims.len() > MAX_RANK {
            return Err(Error::format(format!("{} axes exceed the limit of {MAX_RANK}", dims.len())));
        }
        let wire = self.graph.add(call.name(), operator, inputs, kind, order.stored_dims(dims))?;
        Ok(Value::new(wire, order))
    }

    /// Adds an operator with everything in TensorFlow's order, like [`Lowering::emit`].
    ///
    /// # Errors
    /// `Format` when the graph exceeds the maximum number of nodes.
    pub fn emit_plain(
        &mut self,
        call: &Call,
        operator: Operator,
        inputs: &[&GraphTensor],
        kind: ElementType,
        dims: &[Dim],
    ) -> Result<Value> {
        self.emit(call, operator, inputs, kind, dims, Order::plain(dims.len()))
    }

    /// Returns the tensor stored in `order`; transposes it if needed.
    ///
    /// # Errors
    /// `Internal` when the ranks differ.
    pub fn ordered(&mut self, value: &Value, order: &Order) -> Result<GraphTensor> {
        if value.order == *order {
            return Ok(value.wire.clone());
        }
        if value.rank() != order.rank() {
            return Err(Error::internal(format!(
                "a tensor of rank {} cannot be stored with rank {}",
                value.rank(),
                order.rank()
            )));
        }
        let dims = order.stored_dims(&value.dims());
        let free = value.order.is_reshape_to(order, value.wire.dims());
        let open = dims.iter().filter(|dim| dim.is_none()).count();
        let hint = value.wire.hint();
        if free && open <= 1 {
            let shape = GraphTensor::ints(dims.iter().map(|dim| dim.map_or(-1, |dim| dim as i64)));
            return self.graph.add(
                &hint,
                Operator::new("Reshape"),
                &[&value.wire, &shape],
                value.kind(),
                dims,
            );
        }
        let transpose = Operator::new("Transpose").ints("perm", value.order.permutation_to(order));
        self.graph.add(&hint, transpose, &[&value.wire], value.kind(), dims)
    }

    /// Returns the tensor stored in TensorFlow's order.
    ///
    /// # Errors
    /// `Format` when the graph exceeds the maximum number of nodes.
    pub fn plain(&mut self, value: &Value) -> Result<GraphTensor> {
        self.ordered(value, &Order::plain(value.rank()))
    }

    /// Returns the tensor with the rank of `order`, new axes in front as in broadcasting, stored in `order`.
    /// Constants lose leading axes of size one again.
    ///
    /// # Errors
    /// `Internal` when the tensor has more axes than `order`.
    pub fn broadcastable(&mut self, value: &Value, order: &Order) -> Result<GraphTensor> {
        let missing = order.rank().checked_sub(value.rank());
        let missing =
            missing.ok_or_else(|| Error::internal("a tensor cannot be broadcast to a lower rank"))?;
        if value.wire.element_count() == Some(1) && value.array().is_some() {
            let empty = GraphTensor::ints([]);
            return self.graph.add(
                "",
                Operator::new("Reshape"),
                &[&value.wire, &empty],
                value.kind(),
                Vec::new(),
            );
        }
        if order.is_plain() && value.order.is_plain() {
            return Ok(value.wire.clone());
        }
        let wide = match missing {
            0 => value.clone(),
            _ => {
                let axes = GraphTensor::ints(0..missing as i64);
                let dims = [vec![Some(1); missing], value.wire.dims().to_vec()].concat();
                let unsqueeze = Operator::new("Unsqueeze");
                let hint = value.wire.hint();
                let wire = self.graph.add(&hint, unsqueeze, &[&value.wire, &axes], value.kind(), dims)?;
                let own = value.order.axes().iter().map(|axis| axis + missing);
                Value::new(wire, Order::new((0..missing).chain(own).collect()))
            }
        };
        let stored = self.ordered(&wide, order)?;
        if stored.array().is_none() {
            return Ok(stored);
        }
        let leading = stored.dims().iter().take_while(|dim| **dim == Some(1)).count();
        let axes = GraphTensor::ints(0..leading as i64);
        let dims = stored.dims()[leading..].to_vec();
        self.graph.add("", Operator::new("Squeeze"), &[&stored, &axes], value.kind(), dims)
    }

    /// Returns the tensor with another element type.
    ///
    /// # Errors
    /// `Format` when the graph exceeds the maximum number of nodes.
    pub fn cast(&mut self, wire: &GraphTensor, kind: ElementType) -> Result<GraphTensor> {
        if wire.kind() == kind {
            return Ok(wire.clone());
        }
        let cast = Operator::new("Cast").int("to", kind.data_type() as i64);
        self.graph.add(&wire.hint(), cast, &[wire], kind, wire.dims().to_vec())
    }

    /// Records that `flat` is `source` flattened in TensorFlow's order though stored in another, so that an operator
    /// that can work in any order reads `source` instead.
    pub fn note_flattened(&mut self, flat: &GraphTensor, source: &Value) {
        if flat.array().is_none() {
            self.flattened.insert(flat.hint(), source.clone());
        }
    }

    /// Returns the source recorded by [`Lowering::note_flattened`].
    pub fn flattened(&self, flat: &GraphTensor) -> Option<&Value> {
        self.flattened.get(&flat.hint())
    }
}
