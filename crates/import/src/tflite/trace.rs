//! The graph under construction.

use opendr_engine::{Error, Result, ResultExt};
use opendr_onnx::{ElementType, GraphTensor, Operator};

use super::model::{Model, Node};
use super::step::missing;
use crate::tensorflow::{Attributes, Call, ImportOptions, Lowering, Order, Value, input, ops};

/// The graph under construction, with the tensors of the model.
pub struct Trace<'m, 'a, 'f> {
    pub(super) model: &'m Model<'a, 'f>,
    /// The graph under construction.
    pub lowering: Lowering,
    /// Converted tensors.
    values: Vec<Option<Value>>,
    /// Elements of constants in stored form.
    constants: Vec<Option<GraphTensor>>,
    /// Tensors that are copies of constants.
    same: Vec<Option<usize>>,
}

impl<'m, 'a, 'f> Trace<'m, 'a, 'f> {
    /// Creates a trace with the model's inputs.
    ///
    /// # Errors
    /// `Unsupported` for an input of strings.
    pub fn new(model: &'m Model<'a, 'f>, options: &ImportOptions) -> Result<Self> {
        let count = model.tensors.len();
        let mut trace = Self {
            model,
            lowering: Lowering::default(),
            values: vec![None; count],
            constants: vec![None; count],
            same: vec![None; count],
        };
        for &index in &model.inputs {
            let tensor = &model.tensors[index];
            let kind = match &tensor.quantisation {
                Some(_) => ElementType::Float,
                None => tensor.element.kind().context(|| format!("reading input {:?}", tensor.name))?,
            };
            let value = input(&mut trace.lowering, options, tensor.port(), kind, &tensor.dims);
            trace.define(index, value)?;
        }
        Ok(trace)
    }

    /// Writes TensorFlow's operator `op`.
    pub fn call(
        &mut self,
        name: &str,
        op: &str,
        attr: &Attributes,
        inputs: Vec<Value>,
    ) -> Result<Vec<Value>> {
        let lower = ops::lowering(op).ok_or_else(|| Error::internal(format!("no operator {op:?}")))?;
        lower(&mut self.lowering, &Call::new(name, op, attr, inputs))
    }

    /// Sets a computed tensor; quantised ones are rounded to the values of their integers.
    pub(super) fn define(&mut self, index: usize, value: Value) -> Result<()> {
        let tensor = &self.model.tensors[index];
        if self.values[index].is_some() || tensor.is_constant() {
            return Err(Error::format(format!("tensor {:?} is produced twice", tensor.name)));
        }
        let value = match &tensor.quantisation {
            Some(quantisation) if value.kind() == ElementType::Float => {
                quantisation.rounded(&mut self.lowering, tensor.name, &value)?
            }
            _ => value,
        };
        self.values[index] = Some(value);
        Ok(())
    }

    /// Records that tensor `copy` has the elements of the constant `original`, dequantised where it is quantised.
    pub fn note_same(&mut self, copy: usize, original: usize) {
        if self.model.tensors[original].is_constant() {
            self.same[copy] = Some(original);
        }
    }

    /// Returns a tensor; constants are decoded on first use.
    ///
    /// # Errors
    /// `Format` when no operator has produced it.
    pub fn value(&mut self, index: usize) -> Result<Value> {
        if let Some(value) = &self.values[index] {
            return Ok(value.clone());
        }
        let rank = self.model.tensors[index].dims.len();
        let value = Value::plain(self.constant(index, (0..rank).collect())?);
        self.values[index] = Some(value.clone());
        Ok(value)
    }

    /// Returns an optional input.
    pub fn optional(&mut self, node: &Node, index: usize) -> Result<Option<Value>> {
        node.inputs.get(index).copied().flatten().map(|tensor| self.value(tensor)).transpose()
    }

    /// Returns a required input.
    pub fn input(&mut self, node: &Node, index: usize) -> Result<Value> {
        self.optional(node, index)?.ok_or_else(|| missing(node, index))
    }

    /// Returns all inputs, which are required.
    pub fn inputs(&mut self, node: &Node) -> Result<Vec<Value>> {
        (0..node.inputs.len()).map(|index| self.input(node, index)).collect()
    }

    /// Returns a weight of which TensorFlow's axis `i` is axis `axes[i]`. The axes of a constant, quantised or not,
    /// are stored in the order `stored`.
    ///
    /// # Errors
    /// Those of [`Trace::value`]; `Format` when it has another rank.
    pub fn weight(&mut self, index: usize, axes: &[usize], stored: &Order) -> Result<Value> {
        let index = self.same[index].unwrap_or(index);
        let rank = self.model.tensors[index].dims.len();
        if rank != axes.len() {
            return Err(Error::format(format!("the weights have rank {rank} instead of {}", axes.len())));
        }
        if !self.model.tensors[index].is_constant() {
            let value = self.value(index)?;
            return Ok(Value::new(value.wire.clone(), value.order.transposed(axes)));
        }
        let own = stored.axes().iter().map(|&axis| axes[axis]).collect();
        Ok(Value::new(self.constant(index, own)?, stored.clone()))
    }

    /// Returns the elements of a constant, with its axes in the given order.
    fn constant(&mut self, index: usize, axes: Vec<usize>) -> Result<GraphTensor> {
        let tensor = &self.model.tensors[index];
        if !tensor.is_constant() {
            return Err(Error::format(format!(
                "tensor {:?} is needed, but no preceding operator produces it; download the file again",
                tensor.name
            )));
        }
        let wire = match &self.constants[index] {
            Some(wire) => wire.clone(),
            None => GraphTensor::named_constant(tensor.name, tensor.array()?),
        };
        self.constants[index] = Some(wire.clone());
        let stored = match axes.is_sorted() {
            true => wire,
            false => {
                let transpose = Operator::new("Transpose").ints("perm", axes.iter().map(|&axis| axis as i64));
                let dims = axes.iter().map(|&axis| wire.dims()[axis]).collect();
                let moved = self.lowering.graph.add(tensor.name, transpose, &[&wire], wire.kind(), dims)?;
                moved.array().cloned().map_or(moved, |array| GraphTensor::named_constant(tensor.name, array))
            }
        };
        match &tensor.quantisation {
            Some(quantisation) => quantisation.dequantised(&mut self.lowering, tensor.name, &stored, &axes),
            None => Ok(stored),
        }
    }

    /// Returns the model that is converted.
    pub fn model(&self) -> &'m Model<'a, 'f> {
        self.model
    }
}
