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
fn only_divisions_of_scalar_floats_are_rewritten() {
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

#[test]
fn omitted_attributes_are_inferred() {
    let graph = message(&[(5, &weight(b"w", &[8, 3, 5, 7], 1))]);
    let weights = Weights::read(&graph).unwrap();
    let strides = list_attribute(b"strides", &[2, 2]);
    let node = |kind: &[u8], attributes: &[u8]| {
        let mut node = message(&[(1, b"x"), (1, b"w"), (2, b"y"), (4, kind)]);
        node.extend(attributes);
        node
    };
    let filled = |kind: &[u8], attributes: &[u8]| weights.substitute(&node(kind, attributes)).unwrap();
    let kernel = list_attribute(b"kernel_shape", &[5, 7]);
    let expected = |kind: &[u8], attributes: &[u8]| {
        let mut node = message(&[(1, b"x"), (1, b"w"), (2, b"y"), (3, b"y"), (4, kind)]);
        node.extend(attributes);
        Some(message(&[(1, &node)]))
    };
    assert_eq!(filled(b"Conv", &strides), expected(b"Conv", &[&strides[..], &kernel].concat()));
    assert_eq!(filled(b"Conv", &kernel), None);
    let ones = list_attribute(b"strides", &[1, 1]);
    assert_eq!(filled(b"MaxPool", &kernel), expected(b"MaxPool", &[&kernel[..], &ones].concat()));
    assert_eq!(filled(b"MaxPool", &[&kernel[..], &strides].concat()), None);
}
