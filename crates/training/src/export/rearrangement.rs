//! Operations that move, repeat or convert elements.

use burn::backend::ir::{BaseOperationIr, SliceOpIr, TensorIr};
use burn::tensor::Slice;
use opendr_engine::{Error, Result};
use opendr_onnx::{GraphTensor, Operator};

use super::lowering::{Lowering, kind_from_dtype};
use super::sizes::Size;

pub(super) fn lower(graph: &mut Lowering<'_>, operation: &BaseOperationIr) -> Result<bool> {
    use BaseOperationIr as Op;
    match operation {
        Op::Reshape(op) => reshape(graph, &op.input, &op.out)?,
        Op::Expand(op) => expand(graph, &op.input, &op.out)?,
        Op::SwapDims(op) => {
            let mut order: Vec<usize> = (0..op.input.shape.num_dims()).collect();
            order.swap(op.dim1, op.dim2);
            permute(graph, &op.input, &order, &op.out)?;
        }
        Op::Permute(op) => permute(graph, &op.input, &op.axes, &op.out)?,
        Op::Flip(op) => {
            let axes = || op.axes.iter().map(|&axis| axis as i64);
            let count = op.axes.len();
            let (starts, steps) = (GraphTensor::ints(vec![-1; count]), GraphTensor::ints(vec![-1; count]));
            let ends = GraphTensor::ints(vec![i64::MIN; count]);
            let x = graph.wire(&op.input)?;
            graph.write(
                Operator::new("Slice"),
                &[&x, &starts, &ends, &GraphTensor::ints(axes()), &steps],
                &op.out,
            )?;
        }
        Op::Slice(op) => slice(graph, op)?,
        Op::RepeatDim(op) => repeat(graph, &op.tensor, op.dim, op.times, &op.out)?,
        Op::Cat(op) => {
            let inputs: Vec<&TensorIr> = op.tensors.iter().collect();
            graph.apply(Operator::new("Concat").int("axis", op.dim as i64), &inputs, &op.out)?;
        }
        Op::Cast(op) => cast(graph, &op.input, &op.out)?,
        _ => return Ok(false),
    }
    Ok(true)
}

/// Writes a conversion to another element type. Burn's types of one kind are one type in the file.
pub(super) fn cast(graph: &mut Lowering<'_>, input: &TensorIr, out: &TensorIr) -> Result<()> {
    let (x, kind) = (graph.wire(input)?, kind_from_dtype(out.dtype)?);
    if x.kind() == kind {
        graph.define(out, x);
        return Ok(());
    }
    graph.write(Operator::new("Cast").int("to", kind.data_type() as i64), &[&x], out)
}

/// One open size is inferred by the runtime; further ones are computed.
fn reshape(graph: &mut Lowering<'_>, input: &TensorIr, out: &TensorIr) -> Result<()> {
    let (from, to) = (graph.sizes(input), graph.sizes(out));
    let x = graph.wire(input)?;
    if from == to {
        graph.define(out, x);
        return Ok(());
    }
    let open = to.iter().filter(|size| size.fixed().is_none()).count();
    let shape = match open {
        1 => GraphTensor::ints(to.iter().map(|size| size.fixed().map_or(-1, |size| size as i64))),
        _ => graph.shape(&to)?,
    };
    graph.write(Operator::new("Reshape"), &[&x, &shape], out)
}

/// ONNX broadcasts both ways, so a size of one keeps an open size.
fn expand(graph: &mut Lowering<'_>, input: &TensorIr, out: &TensorIr) -> Result<()> {
    let (from, to) = (graph.sizes(input), graph.sizes(out));
    let x = graph.wire(input)?;
    if from == to {
        graph.define(out, x);
        return Ok(());
    }
    let added = to.len().saturating_sub(from.len());
    let kept = |(axis, size): (usize, &Size)| {
        let same = axis.checked_sub(added).and_then(|axis| from.get(axis)) == Some(size);
        if same && size.fixed().is_none() { Size::Fixed(1) } else { *size }
    };
    let wanted: Vec<Size> = to.iter().enumerate().map(kept).collect();
    let shape = graph.shape(&wanted)?;
    graph.write(Operator::new("Expand"), &[&x, &shape], out)
}

fn permute(graph: &mut Lowering<'_>, input: &TensorIr, order: &[usize], out: &TensorIr) -> Result<()> {
    let operator = Operator::new("Transpose").ints("perm", order.iter().map(|&axis| axis as i64));
    graph.apply(operator, &[input], out)
}

fn repeat(
    graph: &mut Lowering<'_>,
    input: &TensorIr,
    axis: usize,
    times: usize,
    out: &TensorIr,
) -> Result<()> {
    let (from, to) = (graph.sizes(input), graph.sizes(out));
    match (from.get(axis), to.get(axis)) {
        (Some(Size::Fixed(1)), _) => expand(graph, input, out),
        (Some(Size::Fixed(_)), Some(Size::Batch(_))) => Err(Error::unsupported(
            "repeats several elements by the batch size; repeat one element and reshape",
        )),
        _ => {
            let repeats = (0..from.len()).map(|other| if other == axis { times as i64 } else { 1 });
            let x = graph.wire(input)?;
            graph.write(Operator::new("Tile"), &[&x, &GraphTensor::ints(repeats)], out)
        }
    }
}

fn slice(graph: &mut Lowering<'_>, op: &SliceOpIr) -> Result<()> {
    let sizes = graph.sizes(&op.tensor);
    let cuts = |(axis, range): &(usize, &Slice)| {
        let whole = match range.end {
            None => true,
            Some(end) => sizes.get(*axis).and_then(|size| size.fixed()) == usize::try_from(end).ok(),
        };
        range.start != 0 || range.step != 1 || !whole
    };
    let cut: Vec<(usize, &Slice)> = op.ranges.iter().enumerate().filter(cuts).collect();
    let x = graph.wire(&op.tensor)?;
    if cut.is_empty() {
        graph.define(&op.out, x);
        return Ok(());
    }
    let bounds: Vec<(i64, i64)> = cut.iter().map(|(_, range)| bounds(range)).collect();
    let starts = GraphTensor::ints(bounds.iter().map(|bounds| bounds.0));
    let ends = GraphTensor::ints(bounds.iter().map(|bounds| bounds.1));
    let axes = GraphTensor::ints(cut.iter().map(|(axis, _)| *axis as i64));
    let steps = GraphTensor::ints(cut.iter().map(|(_, range)| range.step as i64));
    graph.write(Operator::new("Slice"), &[&x, &starts, &ends, &axes, &steps], &op.out)
}

/// Returns the first position and the one after the last. With a negative step Burn traverses `start..end` backwards, while
/// ONNX takes the first position and the one before the last.
fn bounds(range: &Slice) -> (i64, i64) {
    let (start, end) = (range.start as i64, range.end.map(|end| end as i64));
    match range.step > 0 {
        true => (start, end.unwrap_or(i64::MAX)),
        false => (end.map_or(-1, |end| end - 1), if start == 0 { i64::MIN } else { start - 1 }),
    }
}
