//! Slicing, splitting and unpacking.

use opendr_engine::{Error, Result};

use super::reshape::expanded;
use crate::tensorflow::call::{Call, axis_in};
use crate::tensorflow::lowering::Lowering;
use crate::tensorflow::value::Value;
use opendr_onnx::{Array, Dim, ElementType, GraphTensor, Operator, slice_range};

/// Maximum number of parts, above that of real models.
const MAX_PARTS: usize = 4096;

/// A range of one axis: `start..end` by `step`, negative positions counted from the end.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Range {
    axis: usize,
    start: i64,
    end: i64,
    step: i64,
}

/// Slices ranges of TensorFlow's axes.
fn cut(ctx: &mut Lowering, call: &Call, x: &Value, ranges: &[Range]) -> Result<Value> {
    let mut dims = x.dims();
    let mut kept = Vec::new();
    for range in ranges {
        let Range { axis, start, end, step } = *range;
        let whole = (start, end, step) == (0, i64::MAX, 1);
        let dim = &mut dims[axis];
        if let Some(size) = *dim {
            let (_, count) = slice_range(size, start, end, step)
                .ok_or_else(|| Error::format(format!("the slice {range:?} is not valid")))?;
            if count == size && step == 1 {
                continue;
            }
            *dim = Some(count);
        } else if whole {
            continue;
        } else {
            *dim = None;
        }
        kept.push(*range);
    }
    if kept.is_empty() {
        return Ok(x.clone());
    }
    let list = |f: fn(&Range) -> i64| GraphTensor::ints(kept.iter().map(f));
    let axes = GraphTensor::ints(kept.iter().map(|range| x.order.stored(range.axis) as i64));
    let inputs =
        [&x.wire, &list(|range| range.start), &list(|range| range.end), &axes, &list(|range| range.step)];
    ctx.emit(call, Operator::new("Slice"), &inputs, x.kind(), &dims, x.order.clone())
}

/// Selects one position of TensorFlow's axis `axis`, which is removed.
fn pick(ctx: &mut Lowering, call: &Call, x: &Value, axis: usize, index: i64) -> Result<Value> {
    let mut dims = x.dims();
    let size = dims.remove(axis);
    if let Some(size) = size {
        axis_in(index, size)?;
    }
    let order = x.order.without(&[axis]);
    let stored = x.order.stored(axis) as i64;
    if size == Some(1) {
        let inputs = [&x.wire, &GraphTensor::ints([stored])];
        return ctx.emit(call, Operator::new("Squeeze"), &inputs, x.kind(), &dims, order);
    }
    let index = GraphTensor::constant(Array::int(index));
    ctx.emit(call, Operator::new("Gather").int("axis", stored), &[&x.wire, &index], x.kind(), &dims, order)
}

/// The operations of a `StridedSlice`, axis by axis.
#[derive(Debug, Default, PartialEq)]
struct Plan {
    ranges: Vec<Range>,
    /// Input axes of which one position is selected, with that position.
    picks: Vec<(usize, i64)>,
    /// New axes of the output.
    new_axes: Vec<usize>,
}

/// The masks of `StridedSlice`, bit `i` for entry `i` of `begin`, `end` and `strides`.
struct Masks {
    begin: i64,
    end: i64,
    ellipsis: i64,
    new_axis: i64,
    shrink: i64,
}

fn plan(masks: &Masks, begin: &[i64], end: &[i64], strides: &[i64], rank: usize) -> Result<Plan> {
    let nonsense = || {
        Error::format(format!(
            "the slice {begin:?}..{end:?} by {strides:?} is not valid for a tensor of rank {rank}"
        ))
    };
    if begin.len() != end.len() || begin.len() != strides.len() || begin.len() > 32 {
        return Err(nonsense());
    }
    let set = |mask: i64, i: usize| mask >> i & 1 == 1;
    let consuming = (0..begin.len()).filter(|&i| !set(masks.ellipsis, i) && !set(masks.new_axis, i)).count();
    let mut plan = Plan::default();
    let (mut axis, mut output) = (0, 0);
    for i in 0..begin.len() {
        if set(masks.ellipsis, i) {
            let skipped = rank.checked_sub(consuming).ok_or_else(nonsense)?;
            axis += skipped;
            output += skipped;
        } else if set(masks.new_axis, i) {
            plan.new_axes.push(output);
            output += 1;
        } else if axis >= rank {
            return Err(nonsense());
        } else if set(masks.shrink, i) {
            plan.picks.push((axis, begin[i]));
            axis += 1;
        } else {
            let step = strides[i];
            let (first, last) = if step < 0 { (-1, i64::MIN) } else { (0, i64::MAX) };
            let start = if set(masks.begin, i) { first } else { begin[i] };
            let end = if set(masks.end, i) { last } else { end[i] };
            plan.ranges.push(Range { axis, start, end, step });
            axis += 1;
            output += 1;
        }
    }
    Ok(plan)
}

pub fn strided_slice(ctx: &mut Lowering, call: &Call) -> Result<Vec<Value>> {
    let x = call.input(0)?;
    let mask = |key: &str| call.attr().int(key).unwrap_or(0);
    let masks = Masks {
        begin: mask("begin_mask"),
        end: mask("end_mask"),
        ellipsis: mask("ellipsis_mask"),
        new_axis: mask("new_axis_mask"),
        shrink: mask("shrink_axis_mask"),
    };
    let plan = plan(&masks, call.ints(1)?, call.ints(2)?, call.ints(3)?, x.rank())?;
    let mut value = cut(ctx, call, x, &plan.ranges)?;
    for &(axis, index) in plan.picks.iter().rev() {
        value = pick(ctx, call, &value, axis, index)?;
    }
    for &axis in &plan.new_axes {
        let axis = axis_in(axis as i64, value.rank() + 1)?;
        value = expanded(ctx, call, &value, axis)?;
    }
    Ok(vec![value])
}

pub fn slice(ctx: &mut Lowering, call: &Call) -> Result<Vec<Value>> {
    let x = call.input(0)?;
    let (begin, size) = (call.ints(1)?, call.ints(2)?);
    if begin.len() != x.rank() || size.len() != x.rank() {
        return Err(Error::format(format!(
            "the slice at {begin:?} of size {size:?} is not valid for a tensor of rank {}",
            x.rank()
        )));
    }
    let range = |(axis, (&start, &size)): (usize, (&i64, &i64))| {
        let end = if size < 0 { i64::MAX } else { start.saturating_add(size) };
        Range { axis, start, end, step: 1 }
    };
    let ranges: Vec<Range> = begin.iter().zip(size).enumerate().map(range).collect();
    Ok(vec![cut(ctx, call, x, &ranges)?])
}

pub fn split(ctx: &mut Lowering, call: &Call) -> Result<Vec<Value>> {
    let x = call.input(1)?;
    let axis = axis_in(call.int(0)?, x.rank())?;
    let count = call.attr().int("num_split").and_then(|count| usize::try_from(count).ok());
    let count = count
        .filter(|count| (1..=MAX_PARTS).contains(count))
        .ok_or_else(|| Error::format("the number of parts is out of range"))?;
    let dim = x.dims()[axis];
    match dim.filter(|dim| dim % count == 0) {
        Some(dim) => parts(ctx, call, x, axis, &vec![dim / count; count]),
        None => Err(Error::unsupported(format!("cannot split {dim:?} elements into {count} parts"))),
    }
}

pub fn split_v(ctx: &mut Lowering, call: &Call) -> Result<Vec<Value>> {
    let x = call.input(0)?;
    let axis = axis_in(call.int(2)?, x.rank())?;
    let sizes = call.ints(1)?;
    let nonsense = || Error::format(format!("cannot split {:?} elements into {sizes:?}", x.dims()[axis]));
    let known: usize = sizes
        .iter()
        .filter(|&&size| size >= 0)
        .try_fold(0usize, |sum, &size| sum.checked_add(usize::try_from(size).ok()?))
        .ok_or_else(nonsense)?;
    let rest = x.dims()[axis].and_then(|dim| dim.checked_sub(known));
    let sizes: Option<Vec<usize>> =
        sizes.iter().map(|&size| if size < 0 { rest } else { usize::try_from(size).ok() }).collect();
    let sizes = sizes.filter(|sizes| sizes.len() <= MAX_PARTS).ok_or_else(nonsense)?;
    parts(ctx, call, x, axis, &sizes)
}

/// Splits TensorFlow's axis `axis` into parts of the given sizes.
fn parts(ctx: &mut Lowering, call: &Call, x: &Value, axis: usize, sizes: &[usize]) -> Result<Vec<Value>> {
    let outputs = sizes.iter().map(|&size| {
        let mut dims = x.dims();
        dims[axis] = Some(size);
        (x.kind(), x.order.stored_dims(&dims))
    });
    let outputs: Vec<(ElementType, Vec<Dim>)> = outputs.collect();
    let operator = Operator::new("Split").int("axis", x.order.stored(axis) as i64);
    let lengths = GraphTensor::ints(sizes.iter().map(|&size| size as i64));
    let wires = ctx.graph.add_many(call.name(), operator, &[&x.wire, &lengths], outputs)?;
    Ok(wires.into_iter().map(|wire| Value::new(wire, x.order.clone())).collect())
}

pub fn unpack(ctx: &mut Lowering, call: &Call) -> Result<Vec<Value>> {
    let x = call.input(0)?;
    let axis = axis_in(call.attr().int("axis").unwrap_or(0), x.rank())?;
    let count = call.attr().int("num").and_then(|count| usize::try_from(count).ok()).or(x.dims()[axis]);
    let count = count.filter(|&count| count <= MAX_PARTS);
    let count =
        count.ok_or_else(|| Error::unsupported(format!("unpacking {:?} elements", x.dims()[axis])))?;
    (0..count as i64).map(|index| pick(ctx, call, x, axis, index)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn masks_are_read_entry_by_entry() {
        // x[..., None, 2, 1:] of a tensor of rank 4.
        let masks = Masks { begin: 0, end: 8, ellipsis: 1, new_axis: 2, shrink: 4 };
        let plan = plan(&masks, &[0, 0, 2, 1], &[0, 0, 3, 0], &[1; 4], 4).unwrap();
        let range = Range { axis: 3, start: 1, end: i64::MAX, step: 1 };
        assert_eq!(plan, Plan { ranges: vec![range], picks: vec![(2, 2)], new_axes: vec![2] });
    }

    #[test]
    fn more_entries_than_axes_are_refused() {
        let masks = Masks { begin: 0, end: 0, ellipsis: 0, new_axis: 0, shrink: 0 };
        assert!(plan(&masks, &[0; 3], &[1; 3], &[1; 3], 2).is_err());
        assert!(plan(&masks, &[0; 3], &[1; 2], &[1; 3], 4).is_err());
    }
}
