//! Rewriting of correct ONNX models that rten 0.27 runs wrongly or rejects: some operators ([`substitute`]), and
//! packed lists in attributes, which it does not read and some exporters (burn-onnx) write.

use std::borrow::Cow;

use opendr_engine::Result;

use super::substitute::Weights;
use crate::protobuf::{Field, Fields, Value, put_bytes, put_varint};

/// Returns the model, rewritten where needed. Returns an error when the structure of the model cannot be read.
pub(super) fn repaired(model: &[u8]) -> Result<Cow<'_, [u8]>> {
    rewritten(model, |field| match (field.number, field.value) {
        (7, Value::Bytes(graph)) => {
            let weights = Weights::read(graph)?;
            rewritten_graph(graph, &weights)
        }
        _ => Ok(None),
    })
}

/// Returns a copy of `message` with each field replaced for which `rewrite` returns a new one; the message itself
/// when there is none.
fn rewritten<'a>(
    message: &'a [u8],
    mut rewrite: impl FnMut(&Field<'a>) -> Result<Option<Vec<u8>>>,
) -> Result<Cow<'a, [u8]>> {
    let mut out: Option<Vec<u8>> = None;
    let mut copied = 0;
    for field in Fields::new(message) {
        let field = field?;
        let end = copied + field.raw.len();
        match (rewrite(&field)?, &mut out) {
            (Some(new), None) => out = Some([&message[..copied], &new].concat()),
            (Some(new), Some(out)) => out.extend(new),
            (None, Some(out)) => out.extend(field.raw),
            (None, None) => {}
        }
        copied = end;
    }
    Ok(out.map_or(Cow::Borrowed(message), Cow::Owned))
}

/// Applies `rewritten` to a field that contains a message: returns the whole field, or `None` when nothing changes.
fn rewritten_field<'a>(
    number: u64,
    message: &'a [u8],
    rewrite: impl FnMut(&Field<'a>) -> Result<Option<Vec<u8>>>,
) -> Result<Option<Vec<u8>>> {
    Ok(match rewritten(message, rewrite)? {
        Cow::Borrowed(_) => None,
        Cow::Owned(message) => Some(field_from_message(number, &message)),
    })
}

fn field_from_message(number: u64, message: &[u8]) -> Vec<u8> {
    let mut field = Vec::new();
    put_bytes(&mut field, number, message);
    field
}

fn rewritten_graph(graph: &[u8], weights: &Weights<'_>) -> Result<Option<Vec<u8>>> {
    rewritten_field(7, graph, |field| match (field.number, field.value) {
        (1, Value::Bytes(node)) => {
            let node = unpacked_node(node)?;
            match (weights.substitute(&node)?, node) {
                (Some(nodes), _) => Ok(Some(nodes)),
                (None, Cow::Owned(node)) => Ok(Some(field_from_message(1, &node))),
                (None, Cow::Borrowed(_)) => Ok(None),
            }
        }
        _ => Ok(None),
    })
}

/// Returns the node with unpacked lists in its attributes.
fn unpacked_node(node: &[u8]) -> Result<Cow<'_, [u8]>> {
    rewritten(node, |field| match (field.number, field.value) {
        (5, Value::Bytes(attribute)) => rewritten_field(5, attribute, |field| Ok(unpacked(field))),
        _ => Ok(None),
    })
}

/// Unpacks a packed list of an attribute (7: floats, 8: integers).
fn unpacked(field: &Field<'_>) -> Option<Vec<u8>> {
    let mut list = Vec::new();
    match (field.number, field.value) {
        (7, Value::Bytes(floats)) => {
            for float in floats.chunks_exact(4) {
                put_varint(&mut list, 7 << 3 | 5);
                list.extend(float);
            }
        }
        (8, Value::Bytes(integers)) => {
            let mut integers = Fields::new(integers);
            while let Some(integer) = integers.varint() {
                put_varint(&mut list, 8 << 3);
                put_varint(&mut list, integer);
            }
        }
        _ => return None,
    }
    Some(list)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn message(fields: &[(u64, &[u8])]) -> Vec<u8> {
        let mut message = Vec::new();
        fields.iter().for_each(|(number, bytes)| put_bytes(&mut message, *number, bytes));
        message
    }

    fn model(graph: &[(u64, &[u8])]) -> Vec<u8> {
        message(&[(2, b"producer"), (7, &message(graph)), (3, b"version")])
    }

    #[test]
    fn substitutes_keep_their_place_in_the_graph() {
        let mut four = vec![0x10, 1];
        put_bytes(&mut four, 8, b"four");
        let relu = message(&[(1, b"y"), (2, b"z"), (4, b"Relu")]);
        let division = message(&[(1, b"four"), (1, b"x"), (2, b"y"), (4, b"Div")]);
        let before = model(&[(1, &division), (1, &relu), (5, &four), (11, b"")]);
        let tmp = &b"y/opendr/0"[..];
        let after = model(&[
            (1, &message(&[(1, b"x"), (2, tmp), (3, tmp), (4, b"Reciprocal")])),
            (1, &message(&[(1, tmp), (1, b"four"), (2, b"y"), (3, b"y"), (4, b"Mul")])),
            (1, &relu),
            (5, &four),
            (11, b""),
        ]);
        assert_eq!(repaired(&before).unwrap(), after);
        assert!(matches!(repaired(&after).unwrap(), Cow::Borrowed(_)));
    }

    #[test]
    fn packed_lists_are_written_one_by_one() {
        let packed = message(&[(1, b"pads"), (8, &[1, 0x96, 1, 3])]);
        let mut one_by_one = message(&[(1, b"pads")]);
        one_by_one.extend([0x40, 1, 0x40, 0x96, 1, 0x40, 3]);
        let node = |attribute: &[u8]| message(&[(1, b"x"), (2, b"y"), (4, b"Conv"), (5, attribute)]);
        let (before, after) = (model(&[(1, &node(&packed))]), model(&[(1, &node(&one_by_one))]));
        assert_eq!(repaired(&before).unwrap(), after);
        assert!(matches!(repaired(&after).unwrap(), Cow::Borrowed(_)));
    }
}
