//! What the lowering of every operator uses: writing nodes, and bringing tensors into a wanted order.

use std::collections::HashMap;

use opendr_engine::{Error, Result};

use super::call::Call;
use super::layout::Order;
use super::value::Value;
use opendr_onnx::{Builder, Dim, Kind, Operator, Wire};

/// No real tensor has as many axes; a hostile file could double them with every operator.
pub const MAX_RANK: usize = 32;

/// The graph under construction and what is remembered about its tensors.
#[derive(Default)]
pub struct Lowering {
    /// The ONNX graph.
    pub graph: Builder,
    /// Tensors that are another one flattened against its stored order, see [`Lowering::note_flattened`].
    flattened: HashMap<String, Value>,
}

impl Lowering {
    /// Adds an operator with one output and returns it, stored in `order`. `dims` are TensorFlow's.
    ///
    /// # Errors
    /// `Format` when the graph has grown too large, or the output has more than [`MAX_RANK`] axes.
    pub fn emit(
        &mut self,
        call: &Call,
        operator: Operator,
        inputs: &[&Wire],
        kind: Kind,
        dims: &[Dim],
        order: Order,
    ) -> Result<Value> {
        if dims.len() > MAX_RANK {
            return Err(Error::format(format!("{} axes, more than the {MAX_RANK} allowed", dims.len())));
        }
        let wire = self.graph.add(call.name(), operator, inputs, kind, order.stored_dims(dims))?;
        Ok(Value::new(wire, order))
    }

    /// As [`Lowering::emit`] with everything in TensorFlow's order.
    ///
    /// # Errors
    /// `Format` when the graph has grown too large.
    pub fn emit_plain(
        &mut self,
        call: &Call,
        operator: Operator,
        inputs: &[&Wire],
        kind: Kind,
        dims: &[Dim],
    ) -> Result<Value> {
        self.emit(call, operator, inputs, kind, dims, Order::plain(dims.len()))
    }

    /// The tensor stored in `order`, its elements moved if need be.
    ///
    /// # Errors
    /// `Internal` when the ranks differ.
    pub fn ordered(&mut self, value: &Value, order: &Order) -> Result<Wire> {
        if value.order == *order {
            return Ok(value.wire.clone());
        }
        if value.rank() != order.rank() {
            return Err(Error::internal(format!("rank {} stored as rank {}", value.rank(), order.rank())));
        }
        let dims = order.stored_dims(&value.dims());
        let free = value.order.moves_nothing(order, value.wire.dims());
        let open = dims.iter().filter(|dim| dim.is_none()).count();
        let hint = value.wire.hint();
        if free && open <= 1 {
            let shape = Wire::ints(dims.iter().map(|dim| dim.map_or(-1, |dim| dim as i64)));
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

    /// The tensor stored as TensorFlow names its axes.
    ///
    /// # Errors
    /// `Format` when the graph has grown too large.
    pub fn plain(&mut self, value: &Value) -> Result<Wire> {
        self.ordered(value, &Order::plain(value.rank()))
    }

    /// The tensor with as many axes as `order`, new ones in front as in broadcasting, stored in `order`. Constants
    /// lose leading axes of one element again.
    ///
    /// # Errors
    /// `Internal` when the tensor has more axes than `order`.
    pub fn broadcastable(&mut self, value: &Value, order: &Order) -> Result<Wire> {
        let missing = order.rank().checked_sub(value.rank());
        let missing = missing.ok_or_else(|| Error::internal("broadcasting to a lower rank"))?;
        if value.wire.element_count() == Some(1) && value.array().is_some() {
            let empty = Wire::ints([]);
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
                let axes = Wire::ints(0..missing as i64);
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
        let axes = Wire::ints(0..leading as i64);
        let dims = stored.dims()[leading..].to_vec();
        self.graph.add("", Operator::new("Squeeze"), &[&stored, &axes], value.kind(), dims)
    }

    /// The tensor with another element type.
    ///
    /// # Errors
    /// `Format` when the graph has grown too large.
    pub fn cast(&mut self, wire: &Wire, kind: Kind) -> Result<Wire> {
        if wire.kind() == kind {
            return Ok(wire.clone());
        }
        let cast = Operator::new("Cast").int("to", kind.data_type() as i64);
        self.graph.add(&wire.hint(), cast, &[wire], kind, wire.dims().to_vec())
    }

    /// Remembers that `flat` is `source` flattened in TensorFlow's order though stored in another, so that an
    /// operator for which the order of the elements matters little can read `source` instead.
    pub fn note_flattened(&mut self, flat: &Wire, source: &Value) {
        if flat.array().is_none() {
            self.flattened.insert(flat.hint(), source.clone());
        }
    }

    /// What [`Lowering::note_flattened`] remembered.
    pub fn flattened(&self, flat: &Wire) -> Option<&Value> {
        self.flattened.get(&flat.hint())
    }
}
