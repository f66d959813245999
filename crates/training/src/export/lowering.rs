//! The ONNX graph under construction.

use std::collections::HashMap;

use burn::backend::capture::TensorId;
use burn::backend::ir::{ScalarIr, TensorIr};
use burn::tensor::{DType, Element, TensorData};
use opendr_engine::{Error, Result};
use opendr_onnx::{Array, Builder, Data, Dim, ElementType, GraphTensor, Operator};

use super::input::Declared;
use super::sizes::{Size, Sizes};
use super::trace::Trace;

/// The graph under construction, and the names of its tensors.
pub(super) struct Lowering<'a> {
    pub(super) trace: &'a Trace,
    pub(super) sizes: &'a Sizes,
    pub(super) builder: Builder,
    pub(super) wires: HashMap<TensorId, GraphTensor>,
    /// An input with an open axis, and the axis: the source of the batch size.
    open: Option<(GraphTensor, usize)>,
}

impl<'a> Lowering<'a> {
    /// Creates a graph with inputs.
    pub(super) fn new(
        trace: &'a Trace,
        sizes: &'a Sizes,
        inputs: &[Declared],
        outputs: &[&str],
    ) -> Result<Self> {
        let mut builder = Builder::default();
        for name in outputs {
            builder.reserve(name);
        }
        let mut wires = HashMap::new();
        let mut open = None;
        for (&id, input) in trace.inputs.iter().zip(inputs) {
            if outputs.contains(&input.name.as_str()) {
                return Err(Error::internal(format!(
                    "an input and an output of the model are both called {:?}",
                    input.name
                )));
            }
            let mut dims: Vec<Dim> = input.shape.iter().copied().map(Some).collect();
            if let Some(dim) = input.open.and_then(|axis| dims.get_mut(axis)) {
                *dim = None;
            }
            let names = vec![Size::Batch(1).open_name(); dims.len()];
            let wire = builder.input(&input.name, input.kind, dims, &names);
            if let Some(axis) = input.open {
                open = Some((wire.clone(), axis));
            }
            wires.insert(id, wire);
        }
        Ok(Self { trace, sizes, builder, wires, open })
    }

    /// Returns the wire of a tensor.
    pub(super) fn wire(&mut self, tensor: &TensorIr) -> Result<GraphTensor> {
        self.wire_of(tensor.id)
    }

    /// Returns the wire of the tensor with this id.
    pub(super) fn wire_of(&mut self, id: TensorId) -> Result<GraphTensor> {
        if let Some(wire) = self.wires.get(&id) {
            return Ok(wire.clone());
        }
        let value = self.trace.values.get(&id).ok_or_else(|| {
            Error::unsupported(
                "uses a tensor that is not in the model: an index of a maximum, or an uninitialised tensor",
            )
        })?;
        let name = self.trace.names.get(&id).map_or("constant", String::as_str);
        let wire = GraphTensor::named_constant(name, array_from_data(value)?);
        self.wires.insert(id, wire.clone());
        Ok(wire)
    }

    /// Returns the sizes of a tensor.
    pub(super) fn sizes(&self, tensor: &TensorIr) -> Vec<Size> {
        self.sizes.of(tensor)
    }

    /// Returns the sizes of a tensor, `None` for open ones.
    pub(super) fn dims(&self, tensor: &TensorIr) -> Vec<Dim> {
        self.sizes(tensor).into_iter().map(Size::fixed).collect()
    }

    /// Binds `out` to `wire`.
    pub(super) fn define(&mut self, out: &TensorIr, wire: GraphTensor) {
        self.wires.insert(out.id, wire);
    }

    /// Writes an operator between tensors of the recording.
    pub(super) fn apply(&mut self, operator: Operator, inputs: &[&TensorIr], out: &TensorIr) -> Result<()> {
        let inputs: Vec<GraphTensor> = inputs.iter().map(|input| self.wire(input)).collect::<Result<_>>()?;
        self.write(operator, &inputs.iter().collect::<Vec<_>>(), out)
    }

    /// Writes an operator whose output is a tensor of the recording.
    pub(super) fn write(
        &mut self,
        operator: Operator,
        inputs: &[&GraphTensor],
        out: &TensorIr,
    ) -> Result<()> {
        let wire = self.step(operator, inputs, kind_from_dtype(out.dtype)?, self.dims(out))?;
        self.define(out, wire);
        Ok(())
    }

    /// Writes an operator whose output is not in the recording.
    pub(super) fn step(
        &mut self,
        operator: Operator,
        inputs: &[&GraphTensor],
        kind: ElementType,
        dims: Vec<Dim>,
    ) -> Result<GraphTensor> {
        let hint = operator.name().to_lowercase();
        self.builder.add(&hint, operator, inputs, kind, dims)
    }

    /// Like [`Lowering::step`], for an output with the type and sizes of `model`.
    pub(super) fn step_like(
        &mut self,
        operator: Operator,
        inputs: &[&GraphTensor],
        model: &GraphTensor,
    ) -> Result<GraphTensor> {
        self.step(operator, inputs, model.kind(), model.dims().to_vec())
    }

    /// Writes an operator with several outputs.
    pub(super) fn step_many(
        &mut self,
        operator: Operator,
        inputs: &[&GraphTensor],
        outputs: Vec<(ElementType, Vec<Dim>)>,
    ) -> Result<Vec<GraphTensor>> {
        let hint = operator.name().to_lowercase();
        self.builder.add_many(&hint, operator, inputs, outputs)
    }

    /// Returns sizes as a tensor, which the graph computes where they are open.
    pub(super) fn shape(&mut self, sizes: &[Size]) -> Result<GraphTensor> {
        let fixed: Option<Vec<usize>> = sizes.iter().map(|size| size.fixed()).collect();
        if let Some(fixed) = fixed {
            return Ok(GraphTensor::ints(fixed.into_iter().map(|size| size as i64)));
        }
        let mut parts = Vec::with_capacity(sizes.len());
        for size in sizes {
            parts.push(match size {
                Size::Fixed(size) => GraphTensor::ints([*size as i64]),
                Size::Batch(times) => self.batch(*times)?,
            });
        }
        let parts: Vec<&GraphTensor> = parts.iter().collect();
        self.step(Operator::new("Concat").int("axis", 0), &parts, ElementType::Int, vec![Some(sizes.len())])
    }

    /// Returns `times` the batch size, as a tensor of one element.
    fn batch(&mut self, times: usize) -> Result<GraphTensor> {
        let (input, axis) = self
            .open
            .clone()
            .ok_or_else(|| Error::internal("a size is open, but the model has no open axis"))?;
        let shape =
            self.step(Operator::new("Shape"), &[&input], ElementType::Int, vec![Some(input.rank())])?;
        let index = GraphTensor::ints([axis as i64]);
        let size = self.step(
            Operator::new("Gather").int("axis", 0),
            &[&shape, &index],
            ElementType::Int,
            vec![Some(1)],
        )?;
        match times {
            1 => Ok(size),
            times => {
                let times = GraphTensor::ints([times as i64]);
                self.step(Operator::new("Mul"), &[&size, &times], ElementType::Int, vec![Some(1)])
            }
        }
    }
}

/// Returns the ONNX element type of a Burn type.
pub(super) fn kind_from_dtype(dtype: DType) -> Result<ElementType> {
    match dtype {
        DType::QFloat(_) => {
            Err(Error::unsupported("quantised tensors cannot be exported; dequantise them first"))
        }
        dtype if dtype.is_float() => Ok(ElementType::Float),
        dtype if dtype.is_bool() => Ok(ElementType::Bool),
        _ => Ok(ElementType::Int),
    }
}

/// Returns a scalar of the element type of `dtype`.
pub(super) fn scalar(value: ScalarIr, dtype: DType) -> Result<GraphTensor> {
    Ok(GraphTensor::constant(match kind_from_dtype(dtype)? {
        ElementType::Float => Array::scalar(value.elem()),
        ElementType::Int => Array::int(value.elem()),
        ElementType::Bool => array(Vec::new(), Data::Bool(vec![value.elem()]))?,
    }))
}

/// Returns a constant of these dimensions.
pub(super) fn array(dims: Vec<usize>, data: Data) -> Result<Array> {
    Array::new(dims, data).ok_or_else(|| Error::internal("the elements of a constant do not match its sizes"))
}

/// Returns the elements of a tensor as a constant.
pub(super) fn array_from_data(data: &TensorData) -> Result<Array> {
    let values = match kind_from_dtype(data.dtype())? {
        ElementType::Float => Data::Float(elements(data)?),
        ElementType::Int => Data::Int(elements(data)?),
        ElementType::Bool => Data::Bool(elements(data)?),
    };
    array(data.shape().to_vec(), values)
}

fn elements<E: Element>(data: &TensorData) -> Result<Vec<E>> {
    data.try_to_vec_as::<E>()
        .map_err(|error| Error::internal(format!("a constant cannot be read: {error:?}")))
}
