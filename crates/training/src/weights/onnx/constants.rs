//! Constant tensors of a graph: initialisers, constants, and dequantised values.

use std::collections::HashMap;

use opendr_engine::{Error, Result};
use opendr_onnx::proto::{AttributeProto, DataType, GraphProto, NodeProto, TensorProto};
use opendr_onnx::{FloatType, element_count};

/// Maximum length of a chain of nodes from a constant.
const MAX_CHAIN: usize = 4;

/// A constant tensor, with the name of its initialiser.
pub(super) struct Constant {
    pub name: String,
    pub shape: Vec<usize>,
    pub values: Vec<f32>,
}

impl Constant {
    /// Transposes a matrix; other tensors are unchanged.
    pub fn transpose(&mut self) {
        if let [rows, columns] = self.shape[..] {
            let column = |at| self.values.iter().skip(at).step_by(columns.max(1)).copied();
            self.values = (0..columns).flat_map(column).collect();
            self.shape = vec![columns, rows];
        }
    }
}

pub(super) struct Constants<'g> {
    tensors: HashMap<&'g str, &'g TensorProto>,
    makers: HashMap<&'g str, &'g NodeProto>,
}

impl<'g> Constants<'g> {
    /// Collects the constants of `graph`.
    pub fn of(graph: &'g GraphProto) -> Result<Self> {
        let mut known = Self { tensors: HashMap::new(), makers: HashMap::new() };
        known.tensors.extend(graph.initializer.iter().map(|tensor| (tensor.name.as_str(), tensor)));
        for node in &graph.node {
            let Some(output) = node.output.first() else { continue };
            match node.op_type.as_str() {
                "Constant" => {
                    let value = attribute(node, "value").and_then(|value| value.t.as_ref());
                    known.tensors.extend(value.map(|tensor| (output.as_str(), tensor)));
                }
                "Identity" | "DequantizeLinear" | "Cast" => {
                    known.makers.insert(output, node);
                }
                _ => {}
            }
        }
        match known.tensors.values().find(|tensor| tensor.data_location == 1) {
            Some(tensor) => Err(Error::unsupported(format!(
                "the weight {:.80?} is in another file; save the model as one file",
                tensor.name
            ))),
            None => Ok(known),
        }
    }

    /// Returns the nodes from the tensor `name` back to a stored tensor.
    fn chain(&self, name: &str) -> Option<(&'g str, &'g TensorProto, Vec<&'g NodeProto>)> {
        let (mut name, mut nodes) = (name, Vec::new());
        loop {
            if let Some((&name, &tensor)) = self.tensors.get_key_value(name) {
                return Some((name, tensor, nodes));
            }
            let node = *self.makers.get(name).filter(|_| nodes.len() < MAX_CHAIN)?;
            nodes.push(node);
            name = node.input.first()?.as_str();
        }
    }

    /// Returns the number of elements of the tensor `name`, if it is constant.
    pub fn count(&self, name: &str) -> Option<usize> {
        element_count(&shape_of(self.chain(name)?.1)?)
    }

    /// Returns the tensor `name`, if it is constant and numeric. A tensor that is stored in half precision has the name of the
    /// tensor that it is cast to.
    ///
    /// # Errors
    /// `Format` for inconsistent data.
    pub fn get(&self, requested: &str) -> Result<Option<Constant>> {
        let Some((stored, tensor, nodes)) = self.chain(requested) else { return Ok(None) };
        let cast = nodes.iter().find(|node| node.op_type == "Cast");
        if cast.is_some_and(|node| !is_to_float(node)) {
            return Ok(None);
        }
        let name = if cast.is_some() { requested } else { stored };
        let damaged =
            || Error::format(format!("ONNX: the weight {name:.80?} is damaged; download the file again"));
        let shape = shape_of(tensor).ok_or_else(damaged)?;
        let quantised = nodes.iter().find(|node| node.op_type == "DequantizeLinear");
        let values = match quantised {
            Some(node) => self.dequantised(node, tensor, &shape),
            None => floats(tensor),
        };
        let Some(values) = values else { return Ok(None) };
        match element_count(&shape) == Some(values.len()) {
            true => Ok(Some(Constant { name: name.to_owned(), shape, values })),
            false => Err(damaged()),
        }
    }

    /// Returns `(x - zero) * scale`, with one scale or one per index of an axis.
    fn dequantised(&self, node: &NodeProto, tensor: &TensorProto, shape: &[usize]) -> Option<Vec<f32>> {
        let numbers = integers(tensor)?;
        let stored = |at: usize| self.chain(node.input.get(at)?).map(|(_, tensor, _)| tensor);
        let scales = floats(stored(1)?)?;
        let zeros = match stored(2) {
            Some(zeros) => integers(zeros)?,
            None => vec![0; scales.len()],
        };
        let axis = attribute(node, "axis").map_or(1, |axis| axis.i);
        let axis = if axis < 0 { axis.checked_add(shape.len() as i64)? } else { axis };
        let axis = usize::try_from(axis).ok();
        let behind = match scales.len() {
            1 => numbers.len(),
            count => {
                let axis = axis.filter(|axis| shape.get(*axis) == Some(&count))?;
                element_count(shape.get(axis + 1..)?)?
            }
        };
        let blocks = attribute(node, "block_size").is_some_and(|size| size.i != 0);
        if blocks || zeros.len() != scales.len() || scales.is_empty() {
            return None;
        }
        let number = |(at, number): (usize, &i32)| {
            let place = at / behind.max(1) % scales.len();
            (i64::from(*number) - i64::from(zeros[place])) as f32 * scales[place]
        };
        Some(numbers.iter().enumerate().map(number).collect())
    }
}

/// Returns whether a cast returns floats.
fn is_to_float(cast: &NodeProto) -> bool {
    let kind = attribute(cast, "to").and_then(|to| DataType::try_from(i32::try_from(to.i).ok()?).ok());
    matches!(kind, Some(DataType::Float | DataType::Double | DataType::Float16 | DataType::Bfloat16))
}

fn shape_of(tensor: &TensorProto) -> Option<Vec<usize>> {
    tensor.dims.iter().map(|side| usize::try_from(*side).ok()).collect()
}

/// Returns the elements of a float tensor.
fn floats(tensor: &TensorProto) -> Option<Vec<f32>> {
    let raw = &tensor.raw_data;
    let halves =
        || tensor.int32_data.iter().flat_map(|bits| (*bits as u16).to_le_bytes()).collect::<Vec<u8>>();
    Some(match DataType::try_from(tensor.data_type).ok()? {
        DataType::Float if raw.is_empty() => tensor.float_data.clone(),
        DataType::Double if raw.is_empty() => {
            tensor.double_data.iter().map(|number| *number as f32).collect()
        }
        DataType::Float16 if raw.is_empty() => FloatType::F16.decode(&halves()),
        DataType::Bfloat16 if raw.is_empty() => FloatType::Bf16.decode(&halves()),
        DataType::Float => FloatType::F32.decode(raw),
        DataType::Double => FloatType::F64.decode(raw),
        DataType::Float16 => FloatType::F16.decode(raw),
        DataType::Bfloat16 => FloatType::Bf16.decode(raw),
        _ => return None,
    })
}

/// Returns the elements of an integer tensor.
fn integers(tensor: &TensorProto) -> Option<Vec<i32>> {
    let raw = &tensor.raw_data;
    Some(match DataType::try_from(tensor.data_type).ok()? {
        DataType::Uint8 | DataType::Int8 | DataType::Uint16 | DataType::Int16 | DataType::Int32
            if raw.is_empty() =>
        {
            tensor.int32_data.clone()
        }
        DataType::Uint8 => raw.iter().map(|byte| i32::from(*byte)).collect(),
        DataType::Int8 => raw.iter().map(|byte| i32::from(*byte as i8)).collect(),
        DataType::Uint16 => raw.as_chunks().0.iter().map(|b| i32::from(u16::from_le_bytes(*b))).collect(),
        DataType::Int16 => raw.as_chunks().0.iter().map(|b| i32::from(i16::from_le_bytes(*b))).collect(),
        DataType::Int32 => raw.as_chunks().0.iter().map(|b| i32::from_le_bytes(*b)).collect(),
        _ => return None,
    })
}

/// Returns the attribute of a node by name.
pub(super) fn attribute<'n>(node: &'n NodeProto, name: &str) -> Option<&'n AttributeProto> {
    node.attribute.iter().find(|attribute| attribute.name == name)
}
