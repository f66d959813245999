//! Operators that return positions.

use opendr_engine::{Error, Result};

use super::elementwise::apply;
use super::reshape::as_list;
use crate::tensorflow::call::{Call, axis_in};
use crate::tensorflow::lowering::Lowering;
use crate::tensorflow::value::Value;
use opendr_onnx::{Array, Dim, ElementType, GraphTensor, Operator};

/// Returns the largest values of the last axis, and their positions.
pub fn top_k(ctx: &mut Lowering, call: &Call) -> Result<Vec<Value>> {
    let x = call.input(0)?.clone();
    let last = x.rank().checked_sub(1).ok_or_else(|| Error::format("top-k needs at least one axis"))?;
    let k = as_list(ctx, &call.input(1)?.wire)?;
    let count = k.array().and_then(|k| usize::try_from(*k.as_ints()?.first()?).ok());
    let mut dims = x.dims();
    dims[last] = count;
    let source = unflattened(ctx, &x);
    let searched = match &source {
        Some(source) => stored_flat(ctx, source, &x)?,
        None => x,
    };
    let operator = Operator::new("TopK").int("axis", searched.order.stored(last) as i64);
    let stored = searched.order.stored_dims(&dims);
    let outputs = vec![(searched.kind(), stored.clone()), (ElementType::Int, stored)];
    let wires = ctx.graph.add_many(call.name(), operator, &[&searched.wire, &k], outputs)?;
    let mut values: Vec<Value> =
        wires.into_iter().map(|wire| Value::new(wire, searched.order.clone())).collect();
    if let Some(source) = source
        && let Some(positions) = values.pop()
    {
        values.push(logical_positions(ctx, call, &positions, &source)?);
    }
    Ok(values)
}

/// Returns the source of which `x` is the flattening, if that would move elements and `x` is a single list. Searching
/// the elements in stored order and translating the few positions is cheaper than transposing a heatmap.
fn unflattened(ctx: &Lowering, x: &Value) -> Option<Value> {
    let source = ctx.flattened(&x.wire)?;
    let dims = x.known_dims()?;
    let single = dims.last() == x.wire.element_count().as_ref();
    (single && source.known_dims().is_some()).then(|| source.clone())
}

/// Returns the elements of `source` in stored order, in the shape of `x`.
fn stored_flat(ctx: &mut Lowering, source: &Value, x: &Value) -> Result<Value> {
    let dims = x.wire.dims().to_vec();
    let shape = GraphTensor::ints(dims.iter().map(|dim| dim.map_or(-1, |dim| dim as i64)));
    let hint = source.wire.hint();
    Ok(Value::plain(ctx.graph.add(
        &hint,
        Operator::new("Reshape"),
        &[&source.wire, &shape],
        x.kind(),
        dims,
    )?))
}

/// Axes that are adjacent both in memory and in TensorFlow's order: their number of elements, and the strides in both
/// orders.
struct Run {
    size: usize,
    stored_stride: usize,
    logical_stride: usize,
}

fn runs(source: &Value) -> Option<Vec<Run>> {
    let logical = source.known_dims()?;
    let stride = |dims: &[usize]| dims.iter().product::<usize>();
    let axes: Vec<usize> = source.order.axes().iter().copied().filter(|&axis| logical[axis] != 1).collect();
    let stored: Vec<usize> = axes.iter().map(|&axis| logical[axis]).collect();
    let mut runs: Vec<Run> = Vec::new();
    for (i, &axis) in axes.iter().enumerate() {
        let (size, stored_stride, logical_stride) =
            (stored[i], stride(&stored[i + 1..]), stride(&logical[axis + 1..]));
        match runs.last_mut() {
            Some(run) if run.logical_stride == size * logical_stride => {
                *run = Run { size: run.size * size, stored_stride, logical_stride };
            }
            _ => runs.push(Run { size, stored_stride, logical_stride }),
        }
    }
    Some(runs)
}

/// Converts positions in `source` flattened as stored to positions in `source` flattened in TensorFlow's order.
fn logical_positions(ctx: &mut Lowering, call: &Call, positions: &Value, source: &Value) -> Result<Value> {
    let runs = runs(source).ok_or_else(|| Error::internal("a flattened tensor has an open size"))?;
    let constant = |value: usize| Value::plain(GraphTensor::constant(Array::int(value as i64)));
    let mut total: Option<Value> = None;
    for (i, run) in runs.iter().enumerate() {
        let mut index = positions.clone();
        if run.stored_stride != 1 {
            index = apply(ctx, call, "Div", &index, &constant(run.stored_stride))?;
        }
        if i > 0 {
            index = apply(ctx, call, "Mod", &index, &constant(run.size))?;
        }
        if run.logical_stride != 1 {
            index = apply(ctx, call, "Mul", &index, &constant(run.logical_stride))?;
        }
        total = Some(match total {
            Some(total) => apply(ctx, call, "Add", &total, &index)?,
            None => index,
        });
    }
    Ok(total.unwrap_or_else(|| positions.clone()))
}

/// Returns the position of the largest or smallest value along an axis, which is removed.
pub fn arg(ctx: &mut Lowering, call: &Call) -> Result<Vec<Value>> {
    let x = call.input(0)?;
    let axis = axis_in(call.int(1)?, x.rank())?;
    let mut dims = x.dims();
    dims.remove(axis);
    let name = if call.op() == "ArgMax" { "ArgMax" } else { "ArgMin" };
    let operator = Operator::new(name).int("axis", x.order.stored(axis) as i64).int("keepdims", 0);
    Ok(vec![ctx.emit(call, operator, &[&x.wire], ElementType::Int, &dims, x.order.without(&[axis]))?])
}

/// Returns the index tuples of the true elements.
pub fn where_true(ctx: &mut Lowering, call: &Call) -> Result<Vec<Value>> {
    let x = call.input(0)?;
    let plain = ctx.plain(x)?;
    let plain = ctx.cast(&plain, ElementType::Bool)?;
    let rank = Some(x.rank());
    let found = ctx.graph.add(
        call.name(),
        Operator::new("NonZero"),
        &[&plain],
        ElementType::Int,
        vec![rank, None],
    )?;
    let operator = Operator::new("Transpose").ints("perm", [1, 0]);
    Ok(vec![ctx.emit_plain(call, operator, &[&found], ElementType::Int, &[None, rank])?])
}

/// Converts `NonMaxSuppression`. Inputs: boxes, scores, maximum number of boxes, overlap and score thresholds; `V5` also returns the scores.
pub fn non_max_suppression(ctx: &mut Lowering, call: &Call) -> Result<Vec<Value>> {
    let softened = call.inputs().get(5).is_some_and(|sigma| sigma.array() != Some(&Array::scalar(0.0)));
    if softened || call.attr().flag("pad_to_max_output_size") {
        return Err(Error::unsupported("soft or padded non-maximum suppression is not supported"));
    }
    let (boxes, scores) = (call.input(0)?, call.input(1)?);
    let [boxes_plain, scores_plain] = [ctx.plain(boxes)?, ctx.plain(scores)?];
    let mut unsqueeze = |wire: &GraphTensor, axes: &[i64]| {
        let dims: Vec<Dim> =
            vec![Some(1); axes.len()].into_iter().chain(wire.dims().iter().copied()).collect();
        let axes = GraphTensor::ints(axes.iter().copied());
        ctx.graph.add(call.name(), Operator::new("Unsqueeze"), &[wire, &axes], wire.kind(), dims)
    };
    let (batch_boxes, batch_scores) = (unsqueeze(&boxes_plain, &[0])?, unsqueeze(&scores_plain, &[0, 1])?);
    let count = as_list(ctx, &call.input(2)?.wire)?;
    let (overlap, lowest) = (&call.input(3)?.wire, &call.input(4)?.wire);
    let inputs = [&batch_boxes, &batch_scores, &count, overlap, lowest];
    let operator = Operator::new("NonMaxSuppression");
    let found = ctx.graph.add(call.name(), operator, &inputs, ElementType::Int, vec![None, Some(3)])?;
    // Rows are (batch, class, box).
    let last = GraphTensor::constant(Array::int(2));
    let boxes = ctx.emit_plain(
        call,
        Operator::new("Gather").int("axis", 1),
        &[&found, &last],
        ElementType::Int,
        &[None],
    )?;
    let gather = Operator::new("Gather").int("axis", 0);
    let kept = ctx.emit_plain(call, gather, &[&scores_plain, &boxes.wire], ElementType::Float, &[None])?;
    Ok(vec![boxes, kept])
}
