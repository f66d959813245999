//! Sorting and top-k.

use burn::backend::ir::{NumericOperationIr, TensorIr};
use opendr_engine::{Error, Result};
use opendr_onnx::{ElementType, GraphTensor, Operator};

use super::lowering::Lowering;

pub(super) fn lower(graph: &mut Lowering<'_>, operation: &NumericOperationIr) -> Result<bool> {
    use NumericOperationIr as Op;
    let (x, axis, descending, values, places) = match operation {
        Op::TopK(op) => (&op.input, op.axis, true, Some(&op.out), None),
        Op::ArgTopK(op) => (&op.input, op.axis, true, None, Some(&op.out)),
        Op::TopKWithIndices(op) => (&op.tensor, op.dim, true, Some(&op.out), Some(&op.out_indices)),
        Op::Sort(op) => (&op.input, op.dim, op.descending, Some(&op.out), None),
        Op::ArgSort(op) => (&op.input, op.dim, op.descending, None, Some(&op.out)),
        Op::SortWithIndices(op) => (&op.input, op.dim, op.descending, Some(&op.out), Some(&op.out_indices)),
        _ => return Ok(false),
    };
    sort(graph, x, axis, descending, values, places)?;
    Ok(true)
}

fn sort(
    graph: &mut Lowering<'_>,
    x: &TensorIr,
    axis: usize,
    descending: bool,
    values: Option<&TensorIr>,
    places: Option<&TensorIr>,
) -> Result<()> {
    let Some(out) = values.or(places) else { return Ok(()) };
    let dims = graph.dims(out);
    let count = dims.get(axis).copied().flatten();
    let count =
        count.ok_or_else(|| Error::unsupported("sorts along the open axis; sort along another one"))?;
    let x = graph.wire(x)?;
    let operator =
        Operator::new("TopK").int("axis", axis as i64).int("largest", i64::from(descending)).int("sorted", 1);
    let outputs = vec![(x.kind(), dims.clone()), (ElementType::Int, dims)];
    let sorted = graph.step_many(operator, &[&x, &GraphTensor::ints([count as i64])], outputs)?;
    for (out, wire) in [values, places].into_iter().zip(sorted) {
        if let Some(out) = out {
            graph.define(out, wire);
        }
    }
    Ok(())
}
