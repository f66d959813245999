//! Replacement of operators that rten 0.27 computes wrongly or lacks by equivalent ones.
//!
//! * Division by a single element is computed as a product with the reciprocal and loses the element's dimensions:
//!   `4 / [2]` becomes a scalar, and the next operator that relies on the dimension fails. A division of a scalar
//!   weight becomes `Mul(Reciprocal(b), a)`, whose shape is right.
//! * Bytes cannot be concatenated. Quantised tensors are concatenated as 32-bit integers.
//! * `kernel_shape` of a convolution and `strides` of a pooling are not inferred where a model omits them.

use std::collections::{HashMap, HashSet};

use opendr_engine::Result;

use crate::protobuf::{Field, Fields, Value, put_bytes, put_varint};

/// ONNX's values of `TensorProto.DataType`.
const FLOAT: u64 = 1;
const UINT8: u64 = 2;
const INT8: u64 = 3;
const INT32: u64 = 6;

/// Properties of a graph's values that follow from its weights.
pub(super) struct Weights<'a> {
    /// Float weights without dimensions.
    scalars: HashSet<&'a [u8]>,
    /// Outputs of `QuantizeLinear`, by name, with the type of their zero point.
    quantised: HashMap<&'a [u8], u64>,
    /// Dimensions of the weights.
    dims: HashMap<&'a [u8], Vec<u64>>,
}

impl<'a> Weights<'a> {
    pub(super) fn read(graph: &'a [u8]) -> Result<Self> {
        let mut types = HashMap::new();
        let mut scalars = HashSet::new();
        let mut dims = HashMap::new();
        let mut quantise = Vec::new();
        let mut weight = |name, tensor| -> Result<()> {
            let weight = Weight::read(tensor)?;
            let name = if weight.name.is_empty() { name } else { weight.name };
            if weight.data_type == FLOAT && weight.dims.is_empty() {
                scalars.insert(name);
            }
            types.insert(name, weight.data_type);
            dims.insert(name, weight.dims);
            Ok(())
        };
        for field in Fields::new(graph) {
            let field = field?;
            match (field.number, field.value) {
                (5, Value::Bytes(tensor)) => weight(b"", tensor)?,
                (1, Value::Bytes(node)) => {
                    let node = Node::read(node)?;
                    match (node.kind, node.constant, &node.outputs[..], &node.inputs[..]) {
                        (b"Constant", Some(tensor), &[output], _) => weight(output, tensor)?,
                        (b"QuantizeLinear", _, &[output], &[_, _, zero]) => quantise.push((output, zero)),
                        _ => {}
                    }
                }
                _ => {}
            }
        }
        let quantised = quantise
            .into_iter()
            .filter_map(|(output, zero)| Some((output, *types.get(zero)?)))
            .filter(|(_, data_type)| matches!(*data_type, UINT8 | INT8))
            .collect();
        Ok(Self { scalars, quantised, dims })
    }

    /// Returns the nodes, as fields of the graph, that replace `node`, whose lists are unpacked; `None` when rten
    /// runs it unchanged.
    pub(super) fn substitute(&self, node: &[u8]) -> Result<Option<Vec<u8>>> {
        let node = Node::read(node)?;
        Ok(match (node.kind, &node.inputs[..], &node.outputs[..]) {
            (b"Div", &[dividend, divisor], &[output]) if self.scalars.contains(dividend) => {
                Some(division(dividend, divisor, output))
            }
            (b"Concat", inputs, &[output]) => inputs
                .iter()
                .find_map(|input| self.quantised.get(input))
                .map(|&data_type| concatenation(&node, output, data_type)),
            (b"Conv" | b"ConvTranspose", &[_, kernel, ..], &[output]) if !node.has(b"kernel_shape") => self
                .dims
                .get(kernel)
                .and_then(|dims| dims.get(2..))
                .map(|shape| with_attribute(&node, output, b"kernel_shape", shape)),
            (b"MaxPool" | b"AveragePool", _, &[output]) if !node.has(b"strides") => {
                let rank =
                    node.lists.iter().find(|(name, _)| name == b"kernel_shape").map_or(0, |(_, rank)| *rank);
                Some(with_attribute(&node, output, b"strides", &vec![1; rank]))
            }
            _ => None,
        })
    }
}

fn division(dividend: &[u8], divisor: &[u8], output: &[u8]) -> Vec<u8> {
    let reciprocal = intermediate(output, 0);
    let mut nodes = Vec::new();
    put_node(&mut nodes, b"Reciprocal", &[divisor], &reciprocal, &[]);
    put_node(&mut nodes, b"Mul", &[&reciprocal, dividend], output, &[]);
    nodes
}

fn concatenation(node: &Node<'_>, output: &[u8], data_type: u64) -> Vec<u8> {
    let mut nodes = Vec::new();
    let widened: Vec<_> = (1..).zip(&node.inputs).map(|(index, _)| intermediate(output, index)).collect();
    for (input, widened) in node.inputs.iter().zip(&widened) {
        put_node(&mut nodes, b"Cast", &[input], widened, &cast_attribute(INT32));
    }
    let widened: Vec<_> = widened.iter().map(Vec::as_slice).collect();
    let joined = intermediate(output, 0);
    put_node(&mut nodes, b"Concat", &widened, &joined, &node.attributes);
    put_node(&mut nodes, b"Cast", &[&joined], output, &cast_attribute(data_type));
    nodes
}

fn with_attribute(node: &Node<'_>, output: &[u8], name: &[u8], values: &[u64]) -> Vec<u8> {
    let attributes = [&node.attributes[..], &list_attribute(name, values)].concat();
    let mut nodes = Vec::new();
    put_node(&mut nodes, node.kind, &node.inputs, output, &attributes);
    nodes
}

/// Returns a name that no other value of the graph has.
fn intermediate(output: &[u8], index: usize) -> Vec<u8> {
    [output, format!("/opendr/{index}").as_bytes()].concat()
}

/// Returns the attribute `to` of a `Cast`, as a field of its node.
fn cast_attribute(data_type: u64) -> Vec<u8> {
    const INT: u64 = 2;
    let (mut attribute, mut field) = (Vec::new(), Vec::new());
    put_bytes(&mut attribute, 1, b"to");
    for (number, value) in [(3, data_type), (20, INT)] {
        put_varint(&mut attribute, number << 3);
        put_varint(&mut attribute, value);
    }
    put_bytes(&mut field, 5, &attribute);
    field
}

/// Returns an attribute with a list of integers, as a field of its node.
fn list_attribute(name: &[u8], values: &[u64]) -> Vec<u8> {
    const INTS: u64 = 7;
    let (mut attribute, mut field) = (Vec::new(), Vec::new());
    put_bytes(&mut attribute, 1, name);
    for (number, value) in values.iter().map(|&value| (8, value)).chain([(20, INTS)]) {
        put_varint(&mut attribute, number << 3);
        put_varint(&mut attribute, value);
    }
    put_bytes(&mut field, 5, &attribute);
    field
}

fn put_node(nodes: &mut Vec<u8>, kind: &[u8], inputs: &[&[u8]], output: &[u8], attributes: &[u8]) {
    let mut node = Vec::new();
    inputs.iter().for_each(|input| put_bytes(&mut node, 1, input));
    put_bytes(&mut node, 2, output);
    // The node name is that of the output, which is unique.
    put_bytes(&mut node, 3, output);
    put_bytes(&mut node, 4, kind);
    node.extend(attributes);
    put_bytes(nodes, 1, &node);
}

/// The parts of a node that determine whether it is replaced.
#[derive(Default)]
struct Node<'a> {
    kind: &'a [u8],
    inputs: Vec<&'a [u8]>,
    outputs: Vec<&'a [u8]>,
    /// Attributes, as fields.
    attributes: Vec<u8>,
    /// Names of the attributes, and their numbers of integers.
    lists: Vec<(&'a [u8], usize)>,
    /// Tensor of a `Constant`.
    constant: Option<&'a [u8]>,
}

impl<'a> Node<'a> {
    fn has(&self, attribute: &[u8]) -> bool {
        self.lists.iter().any(|(name, _)| *name == attribute)
    }

    fn read(bytes: &'a [u8]) -> Result<Self> {
        let mut node = Self::default();
        for field in Fields::new(bytes) {
            let field = field?;
            match (field.number, field.value) {
                (1, Value::Bytes(name)) => node.inputs.push(name),
                (2, Value::Bytes(name)) => node.outputs.push(name),
                (4, Value::Bytes(kind)) => node.kind = kind,
                (5, Value::Bytes(attribute)) => {
                    let mut name = &[][..];
                    let mut count = 0;
                    for part in Fields::new(attribute) {
                        match part? {
                            Field { number: 1, value: Value::Bytes(bytes), .. } => name = bytes,
                            Field { number: 5, value: Value::Bytes(tensor), .. } => {
                                node.constant = Some(tensor)
                            }
                            Field { number: 8, .. } => count += 1,
                            _ => {}
                        }
                    }
                    node.lists.push((name, count));
                    // Weights can be large, and no replaced node has any.
                    if node.constant.is_none() {
                        node.attributes.extend(field.raw);
                    }
                }
                _ => {}
            }
        }
        Ok(node)
    }
}

/// Name, element type and dimensions of a weight.
struct Weight<'a> {
    name: &'a [u8],
    data_type: u64,
    dims: Vec<u64>,
}

impl<'a> Weight<'a> {
    fn read(tensor: &'a [u8]) -> Result<Self> {
        let mut weight = Self { name: &[], data_type: 0, dims: Vec::new() };
        for field in Fields::new(tensor) {
            let field = field?;
            match (field.number, field.value) {
                (1, Value::Varint(dim)) => weight.dims.push(dim),
                (1, Value::Bytes(packed)) => {
                    let mut packed = Fields::new(packed);
                    weight.dims.extend(std::iter::from_fn(|| packed.varint()));
                }
                (2, Value::Varint(data_type)) => weight.data_type = data_type,
                (8, Value::Bytes(name)) => weight.name = name,
                _ => {}
            }
        }
        Ok(weight)
    }
}

#[cfg(test)]
mod tests;
