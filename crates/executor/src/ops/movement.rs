//! Operators that move elements: transposes, slices, expansion, padding, concatenation.

use opendr_engine::Result;
use opendr_onnx::proto::NodeProto;

use super::inputs::{axis, list, optional, required};
use crate::attributes::Attributes;
use crate::io::{Io, Kernel};
use crate::planner::{Id, Layout, Planner};
use crate::remap::{Axis, Remap, by_size, strides, transposed};
use crate::tensor::count;

/// Emits a copy of a plain value.
fn emit(planner: &mut Planner<'_>, x: Id, axes: Vec<Axis>, shape: Vec<usize>) -> Result<Id> {
    let kind = planner.kind(x);
    planner.emit_one(Remap::new(axes, kind.bytes()), &[x], kind, shape, Layout::Plain)
}

pub(crate) fn transpose(
    planner: &mut Planner<'_>,
    node: &NodeProto,
    inputs: &[Option<Id>],
) -> Result<Vec<Id>> {
    let x = required(node, inputs, 0)?;
    let shape = planner.shape(x);
    let rank = shape.len();
    let order = match node.ints("perm") {
        Some(order) => order.iter().map(|&dim| axis(node, dim, rank)).collect::<Result<Vec<_>>>()?,
        None => (0..rank).rev().collect(),
    };
    let mut sorted = order.clone();
    sorted.sort_unstable();
    if !sorted.into_iter().eq(0..rank) {
        return Err(node.damaged("attribute \"perm\" is no permutation"));
    }
    let to: Vec<usize> = order.iter().map(|&dim| shape[dim]).collect();
    let mut last: Vec<usize> = (0..rank).collect();
    if rank > 2 {
        last[1..].rotate_left(1);
    }
    let mut first: Vec<usize> = (0..rank).collect();
    if rank > 2 {
        first[1..].rotate_right(1);
    }
    if rank > 2 && order == last && planner.is_channels_last(x) {
        return Ok(vec![planner.alias(x, to, Layout::Plain)]);
    }
    if rank > 2 && order == first && !planner.is_channels_last(x) {
        return Ok(vec![planner.alias(x, to, Layout::ChannelsLast)]);
    }
    // Read in the order of memory, whatever the layout.
    let value = planner.value(x).clone();
    let position = |dim: usize| match value.layout {
        Layout::Plain => dim,
        Layout::ChannelsLast => last.iter().position(|&at| at == dim).unwrap_or(dim),
    };
    let order: Vec<usize> = order.iter().map(|&dim| position(dim)).collect();
    let remap = transposed(&value.physical(), &order, value.kind.bytes());
    Ok(vec![planner.emit_one(remap, &[x], value.kind, to, Layout::Plain)?])
}

pub(crate) fn expand(planner: &mut Planner<'_>, node: &NodeProto, inputs: &[Option<Id>]) -> Result<Vec<Id>> {
    let x = required(node, inputs, 0)?;
    let x = planner.plain(x)?;
    let wanted = sizes(node, &planner.ints(node, required(node, inputs, 1)?)?)?;
    let shape = super::broadcast::broadcast_shape(node, &[planner.shape(x), wanted])?;
    count(&shape)?;
    let dims = planner.shape(x);
    let missing = shape.len() - dims.len();
    let strides = strides(&dims);
    let axes = shape.iter().enumerate().map(|(i, &length)| {
        let stride = i.checked_sub(missing).filter(|&d| dims[d] != 1).map_or(0, |d| strides[d]);
        Axis::Strided { length, stride }
    });
    Ok(vec![emit(planner, x, axes.collect(), shape)?])
}

/// Converts a list of sizes.
pub(crate) fn sizes(node: &NodeProto, values: &[i64]) -> Result<Vec<usize>> {
    values
        .iter()
        .map(|&value| usize::try_from(value).map_err(|_| node.damaged(&format!("a size is {value}"))))
        .collect()
}

pub(crate) fn tile(planner: &mut Planner<'_>, node: &NodeProto, inputs: &[Option<Id>]) -> Result<Vec<Id>> {
    let x = required(node, inputs, 0)?;
    let x = planner.plain(x)?;
    let repeats = sizes(node, &planner.ints(node, required(node, inputs, 1)?)?)?;
    let dims = planner.shape(x);
    if repeats.len() != dims.len() {
        return Err(node.damaged("one repetition per dimension"));
    }
    let shape: Option<Vec<usize>> =
        dims.iter().zip(&repeats).map(|(&dim, &repeat)| dim.checked_mul(repeat)).collect();
    let shape = shape.ok_or_else(|| node.damaged("too many repetitions"))?;
    count(&shape)?;
    let axes = dims.iter().zip(&repeats).zip(strides(&dims)).flat_map(|((&length, &repeat), stride)| {
        [Axis::Strided { length: repeat, stride: 0 }, Axis::Strided { length, stride }]
    });
    Ok(vec![emit(planner, x, axes.collect(), shape)?])
}

pub(crate) fn slice(planner: &mut Planner<'_>, node: &NodeProto, inputs: &[Option<Id>]) -> Result<Vec<Id>> {
    let x = required(node, inputs, 0)?;
    let starts = list(planner, node, inputs, "starts", 1)?.ok_or_else(|| node.damaged("no starts"))?;
    let ends = list(planner, node, inputs, "ends", 2)?.ok_or_else(|| node.damaged("no ends"))?;
    let axes = list(planner, node, inputs, "axes", 3)?;
    let axes = axes.unwrap_or_else(|| (0..starts.len() as i64).collect());
    let steps = match optional(inputs, 4) {
        Some(id) => planner.ints(node, id)?,
        None => vec![1; starts.len()],
    };
    if ends.len() != starts.len() || axes.len() != starts.len() || steps.len() != starts.len() {
        return Err(node.damaged("starts, ends, axes and steps of different lengths"));
    }
    let dims = planner.shape(x);
    let mut ranges: Vec<Option<Vec<usize>>> = vec![None; dims.len()];
    for (((&start, &end), &along), &step) in starts.iter().zip(&ends).zip(&axes).zip(&steps) {
        let along = axis(node, along, dims.len())?;
        let range = opendr_onnx::slice_range(dims[along], start, end, step);
        let (first, count) = range.ok_or_else(|| node.damaged("a step of 0"))?;
        let step = isize::try_from(step).unwrap_or(isize::MAX);
        ranges[along] =
            Some((0..count).map(|i| first.wrapping_add_signed(step.wrapping_mul(i as isize))).collect());
    }
    take(planner, x, &ranges)
}

/// Copies some indices of each dimension; `None` stands for all.
fn take(planner: &mut Planner<'_>, x: Id, ranges: &[Option<Vec<usize>>]) -> Result<Vec<Id>> {
    let value = planner.value(x).clone();
    let shape: Vec<usize> =
        value.shape.iter().zip(ranges).map(|(&dim, range)| range.as_ref().map_or(dim, Vec::len)).collect();
    if shape == value.shape && ranges.iter().flatten().all(|range| range.iter().copied().eq(0..range.len())) {
        return Ok(vec![x]);
    }
    let mut limited = (0..ranges.len()).filter(|&d| ranges[d].is_some());
    if let (Some(along), None) = (limited.next(), limited.next())
        && let Some(images) = planner.images(x, along)
    {
        let mut of_images = vec![None; planner.rank(images)];
        of_images[0].clone_from(&ranges[along]);
        let taken = take(planner, images, &of_images)?;
        return taken.into_iter().map(|id| planner.reshaped(id, shape.clone())).collect();
    }
    let (dims, mut ranges) = (value.physical(), ranges.to_vec());
    if value.layout == Layout::ChannelsLast {
        ranges[1..].rotate_left(1);
    }
    let strides = strides(&dims);
    if let Some(start) = first_of_outermost(&dims, &ranges) {
        let bytes = start * value.kind.bytes();
        if let Some(part) = planner.view(x, bytes, shape.clone(), value.layout) {
            return Ok(vec![part]);
        }
    }
    let mut base = 0;
    let mut axes = Vec::new();
    for ((length, stride), range) in dims.iter().zip(&strides).zip(&ranges) {
        axes.push(match range {
            None => Axis::Strided { length: *length, stride: *stride },
            Some(range) => match range.as_slice() {
                [] => Axis::Strided { length: 0, stride: 0 },
                [first, rest @ ..] => {
                    let step = rest.first().map_or(1, |next| next.wrapping_sub(*first));
                    let even = range
                        .iter()
                        .enumerate()
                        .all(|(i, &at)| at == first.wrapping_add(i.wrapping_mul(step)));
                    if even && step < usize::MAX / 2 {
                        base += first * stride;
                        Axis::Strided { length: range.len(), stride: step * stride }
                    } else {
                        Axis::Table(range.iter().map(|at| at * stride).collect())
                    }
                }
            },
        });
    }
    if base > 0 {
        axes.insert(0, Axis::Table(vec![base]));
    }
    let remap = Remap::new(axes, value.kind.bytes());
    Ok(vec![planner.emit_one(remap, &[x], value.kind, shape, value.layout)?])
}

/// Returns the first element of consecutive indices of the outermost dimension of more than 1, where no other one is limited.
fn first_of_outermost(dims: &[usize], ranges: &[Option<Vec<usize>>]) -> Option<usize> {
    let along = dims.iter().position(|&dim| dim > 1)?;
    let range = ranges[along].as_ref()?;
    let others = (0..dims.len()).filter(|&d| d != along);
    let is_all = |d: usize| ranges[d].as_ref().is_none_or(|range| range.len() == dims[d]);
    let first = *range.first()?;
    let is_part = range.iter().copied().eq(first..first + range.len()) && others.into_iter().all(is_all);
    is_part.then(|| first * dims[along + 1..].iter().product::<usize>())
}

pub(crate) fn split(planner: &mut Planner<'_>, node: &NodeProto, inputs: &[Option<Id>]) -> Result<Vec<Id>> {
    let x = required(node, inputs, 0)?;
    let dims = planner.shape(x);
    let along = axis(node, node.int_or("axis", 0), dims.len())?;
    let parts = match list(planner, node, inputs, "split", 1)? {
        Some(parts) => sizes(node, &parts)?,
        None => {
            let length = dims[along].div_ceil(node.output.len().max(1));
            (0..node.output.len()).map(|i| length.min(dims[along].saturating_sub(i * length))).collect()
        }
    };
    if parts.iter().try_fold(0_usize, |sum, &part| sum.checked_add(part)) != Some(dims[along]) {
        return Err(node.damaged(&format!("parts {parts:?} of a dimension of {}", dims[along])));
    }
    let mut first = 0;
    let mut outputs = Vec::new();
    for part in parts {
        let mut ranges = vec![None; dims.len()];
        ranges[along] = Some((first..first + part).collect());
        outputs.extend(take(planner, x, &ranges)?);
        first += part;
    }
    Ok(outputs)
}

pub(crate) fn pad(planner: &mut Planner<'_>, node: &NodeProto, inputs: &[Option<Id>]) -> Result<Vec<Id>> {
    let x = required(node, inputs, 0)?;
    let value = planner.value(x).clone();
    let rank = value.shape.len();
    let mut pads = list(planner, node, inputs, "pads", 1)?.ok_or_else(|| node.damaged("no pads"))?;
    if let Some(axes) = optional(inputs, 3) {
        let axes = planner.ints(node, axes)?;
        if pads.len() != 2 * axes.len() {
            return Err(node.damaged("two pads per axis"));
        }
        let mut all = vec![0; 2 * rank];
        for (i, &along) in axes.iter().enumerate() {
            let along = axis(node, along, rank)?;
            (all[along], all[rank + along]) = (pads[i], pads[axes.len() + i]);
        }
        pads = all;
    }
    if pads.len() != 2 * rank || pads.iter().any(|pad| pad.abs() > 1 << 24) {
        return Err(node.damaged(&format!("pads {pads:?}")));
    }
    let mode = node.text("mode", "constant");
    let mut dims: Vec<usize> = (0..rank).collect();
    if value.layout == Layout::ChannelsLast {
        dims[1..].rotate_left(1);
    }
    let (mut tables, mut shape) = (Vec::new(), value.shape.clone());
    for &dim in &dims {
        let size = value.shape[dim] as i64;
        let (before, after) = (pads[dim], pads[rank + dim]);
        let table: Option<Vec<Option<usize>>> = (-before..size + after)
            .map(|at| match mode.as_str() {
                _ if (0..size).contains(&at) => Some(usize::try_from(at).ok()),
                "constant" => Some(None),
                "edge" if size > 0 => Some(usize::try_from(at.clamp(0, size - 1)).ok()),
                "wrap" if size > 0 => Some(usize::try_from(at.rem_euclid(size)).ok()),
                "reflect" if size > 1 => {
                    let at = at.rem_euclid(2 * size - 2);
                    Some(usize::try_from(at.min(2 * size - 2 - at)).ok())
                }
                _ => None,
            })
            .collect();
        let table = table.ok_or_else(|| node.refused(&format!("mode {mode:?}")))?;
        shape[dim] = table.len();
        tables.push(table);
    }
    count(&shape)?;
    let fill = optional(inputs, 2);
    if mode == "constant" && node.find("value").is_some_and(|value| value.f != 0.0) {
        return Err(node.refused("attribute \"value\""));
    }
    let kernel = PadCopy { tables, dims: value.physical(), size: value.kind.bytes() };
    let ids = planner.emit(kernel, &[Some(x), fill], &[(value.kind, shape, value.layout)])?;
    Ok(ids)
}

/// Copies with some indices of the output outside of the input.
struct PadCopy {
    tables: Vec<Vec<Option<usize>>>,
    dims: Vec<usize>,
    size: usize,
}

impl Kernel for PadCopy {
    fn run(&self, io: &mut Io<'_>) -> Result<()> {
        by_size!(self.size, T => {
            let x = io.read::<T>(0);
            let fill = io.read::<T>(1).first().copied().unwrap_or_default();
            let y = io.write::<T>();
            let Some((last, outer)) = self.tables.split_last() else {
                y.copy_from_slice(x);
                return Ok(());
            };
            let strides = strides(&self.dims);
            let run: Vec<(usize, usize, usize)> = runs(last);
            for (mut row, y) in y.chunks_mut(last.len().max(1)).enumerate() {
                let mut from = Some(0);
                for (table, stride) in outer.iter().zip(&strides).rev() {
                    let at = table[row % table.len()];
                    row /= table.len();
                    from = from.zip(at).map(|(from, at)| from + at * stride);
                }
                y.fill(fill);
                if let Some(from) = from {
                    for &(to, at, length) in &run {
                        y[to..to + length].copy_from_slice(&x[from + at..from + at + length]);
                    }
                }
            }
        });
        Ok(())
    }
}

/// Returns runs of consecutive indices: position in the table, first index, length.
fn runs(table: &[Option<usize>]) -> Vec<(usize, usize, usize)> {
    let mut runs: Vec<(usize, usize, usize)> = Vec::new();
    for (to, at) in table.iter().enumerate() {
        let Some(at) = *at else { continue };
        match runs.last_mut() {
            Some((start, first, length)) if *start + *length == to && *first + *length == at => *length += 1,
            _ => runs.push((to, at, 1)),
        }
    }
    runs
}

pub(crate) fn depth_to_space(
    planner: &mut Planner<'_>,
    node: &NodeProto,
    inputs: &[Option<Id>],
) -> Result<Vec<Id>> {
    let x = required(node, inputs, 0)?;
    let x = planner.plain(x)?;
    let [batch, channels, height, width] = planner.shape(x)[..] else {
        return Err(node.damaged("four dimensions"));
    };
    let block =
        usize::try_from(node.int_or("blocksize", 0)).ok().filter(|block| (1..1 << 12).contains(block));
    let block = block.ok_or_else(|| node.damaged("attribute \"blocksize\""))?;
    let size = planner.kind(x).bytes();
    let (split, order, shape): (Vec<usize>, [usize; 6], Vec<usize>) = if node.op_type == "SpaceToDepth" {
        if height % block != 0 || width % block != 0 {
            return Err(node.damaged("the blocks do not fit"));
        }
        let shape = vec![batch, channels * block * block, height / block, width / block];
        let order = if node.text("mode", "DCR") == "CRD" { [0, 1, 3, 5, 2, 4] } else { [0, 3, 5, 1, 2, 4] };
        (vec![batch, channels, height / block, block, width / block, block], order, shape)
    } else {
        let fewer = channels / (block * block);
        if fewer * block * block != channels {
            return Err(node.damaged("the blocks do not fit"));
        }
        let shape = vec![batch, fewer, height * block, width * block];
        if node.text("mode", "DCR") == "CRD" {
            (vec![batch, fewer, block, block, height, width], [0, 1, 4, 2, 5, 3], shape)
        } else {
            (vec![batch, block, block, fewer, height, width], [0, 3, 4, 1, 5, 2], shape)
        }
    };
    let remap = transposed(&split, &order, size);
    let kind = planner.kind(x);
    Ok(vec![planner.emit_one(remap, &[x], kind, shape, Layout::Plain)?])
}

/// Repeats a value of one element.
pub(crate) fn repeated(planner: &mut Planner<'_>, x: Id, shape: Vec<usize>) -> Result<Id> {
    count(&shape)?;
    let axes = shape.iter().map(|&length| Axis::Strided { length, stride: 0 }).collect();
    emit(planner, x, axes, shape)
}
