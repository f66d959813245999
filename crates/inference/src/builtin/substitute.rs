//! Operators that rten 0.27 gets wrong or lacks, in terms of others.
//!
//! * It divides by a single element as a product with the reciprocal and forgets the element's dimensions: `4 / [2]`
//!   becomes a scalar, and the next operator that relies on the dimension fails. A scalar weight over anything becomes
//!   `Mul(Reciprocal(b), a)`, whose shape is right.
//! * It concatenates no bytes. Quantised tensors are joined as 32-bit integers.

use std::collections::{HashMap, HashSet};

use opendr_engine::Result;

use crate::protobuf::{Field, Fields, Value, put_bytes, put_varint};

/// ONNX's numbers for element types.
const FLOAT: u64 = 1;
const UINT8: u64 = 2;
const INT8: u64 = 3;
const INT32: u64 = 6;

/// What a graph's weights say about its values.
pub(super) struct Weights<'a> {
    /// Float weights without dimensions.
    scalars: HashSet<&'a [u8]>,
    /// Outputs of `QuantizeLinear`, by name, with the type of their zero point.
    quantised: HashMap<&'a [u8], u64>,
}

impl<'a> Weights<'a> {
    pub(super) fn read(graph: &'a [u8]) -> Result<Self> {
        let mut types = HashMap::new();
        let mut scalars = HashSet::new();
        let mut quantise = Vec::new();
        let mut weight = |name, tensor| -> Result<()> {
            let weight = Weight::read(tensor)?;
            let name = if weight.name.is_empty() { name } else { weight.name };
            if weight.data_type == FLOAT && weight.scalar {
                scalars.insert(name);
            }
            types.insert(name, weight.data_type);
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
        Ok(Self { scalars, quantised })
    }

    /// The nodes, as fields of the graph, that stand for `node`; `None` when rten runs it as it is.
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

/// A name that no other value of the graph has.
fn intermediate(output: &[u8], index: usize) -> Vec<u8> {
    [output, format!("/opendr/{index}").as_bytes()].concat()
}

/// The attribute `to` of a `Cast`, as field of its node.
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

fn put_node(nodes: &mut Vec<u8>, kind: &[u8], inputs: &[&[u8]], output: &[u8], attributes: &[u8]) {
    let mut node = Vec::new();
    inputs.iter().for_each(|input| put_bytes(&mut node, 1, input));
    put_bytes(&mut node, 2, output);
    // A name of its own: what the output is called is unique.
    put_bytes(&mut node, 3, output);
    put_bytes(&mut node, 4, kind);
    node.extend(attributes);
    put_bytes(nodes, 1, &node);
}

/// What decides about a node.
#[derive(Default)]
struct Node<'a> {
    kind: &'a [u8],
    inputs: Vec<&'a [u8]>,
    outputs: Vec<&'a [u8]>,
    /// Its attributes, as fields.
    attributes: Vec<u8>,
    /// The tensor that a `Constant` holds.
    constant: Option<&'a [u8]>,
}

impl<'a> Node<'a> {
    fn read(bytes: &'a [u8]) -> Result<Self> {
        let mut node = Self::default();
        for field in Fields::new(bytes) {
            let field = field?;
            match (field.number, field.value) {
                (1, Value::Bytes(name)) => node.inputs.push(name),
                (2, Value::Bytes(name)) => node.outputs.push(name),
                (4, Value::Bytes(kind)) => node.kind = kind,
                (5, Value::Bytes(attribute)) => {
                    for part in Fields::new(attribute) {
                        if let Field { number: 5, value: Value::Bytes(tensor), .. } = part? {
                            node.constant = Some(tensor);
                        }
                    }
                    // Weights can be large, and no node that is replaced has any.
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

/// What decides about a weight.
struct Weight<'a> {
    name: &'a [u8],
    data_type: u64,
    scalar: bool,
}

impl<'a> Weight<'a> {
    fn read(tensor: &'a [u8]) -> Result<Self> {
        let mut weight = Self { name: &[], data_type: 0, scalar: true };
        for field in Fields::new(tensor) {
            let field = field?;
            match (field.number, field.value) {
                (1, Value::Bytes([])) => {}
                (1, _) => weight.scalar = false,
                (2, Value::Varint(data_type)) => weight.data_type = data_type,
                (8, Value::Bytes(name)) => weight.name = name,
                _ => {}
            }
        }
        Ok(weight)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn message(fields: &[(u64, &[u8])]) -> Vec<u8> {
        let mut message = Vec::new();
        fields.iter().for_each(|(number, bytes)| put_bytes(&mut message, *number, bytes));
        message
    }

    fn weight(name: &[u8], dims: &[u8], data_type: u8) -> Vec<u8> {
        let mut weight: Vec<u8> = dims.iter().flat_map(|&dim| [0x08, dim]).collect();
        weight.extend([0x10, data_type]);
        put_bytes(&mut weight, 8, name);
        weight
    }

    #[test]
    fn only_scalar_floats_are_divided_anew() {
        let division = message(&[(1, b"four"), (1, b"x"), (2, b"y"), (4, b"Div")]);
        for (dims, data_type, replaced) in [(&[][..], 1, true), (&[1], 1, false), (&[], 6, false)] {
            let graph = message(&[(5, &weight(b"four", dims, data_type))]);
            let weights = Weights::read(&graph).unwrap();
            assert_eq!(weights.substitute(&division).unwrap().is_some(), replaced, "{dims:?} {data_type}");
        }
    }

    #[test]
    fn bytes_are_joined_as_integers_and_floats_as_they_are() {
        let quantise = message(&[(1, b"a"), (1, b"scale"), (1, b"zero"), (2, b"q"), (4, b"QuantizeLinear")]);
        let graph = message(&[(1, &quantise), (5, &weight(b"zero", &[], 2))]);
        let weights = Weights::read(&graph).unwrap();
        let join =
            |input: &[u8]| message(&[(1, input), (1, b"r"), (2, b"j"), (4, b"Concat"), (5, b"\x0a\x04axis")]);
        assert!(weights.substitute(&join(b"a")).unwrap().is_none());
        let nodes = weights.substitute(&join(b"q")).unwrap().unwrap();
        let nodes: Vec<_> = Fields::new(&nodes)
            .map(|field| match field.unwrap().value {
                Value::Bytes(node) => Node::read(node).unwrap(),
                _ => unreachable!(),
            })
            .collect();
        let kinds: Vec<_> = nodes.iter().map(|node| node.kind).collect();
        assert_eq!(kinds, [&b"Cast"[..], b"Cast", b"Concat", b"Cast"]);
        assert_eq!(nodes[2].inputs, [nodes[0].outputs[0], nodes[1].outputs[0]]);
        assert_eq!(nodes[2].attributes, message(&[(5, b"\x0a\x04axis")]));
        assert_eq!(nodes[3].inputs, nodes[2].outputs);
        assert_eq!(nodes[3].outputs, [b"j"]);
    }
}
