//! Operators that only move elements.

use super::super::array::{Array, Data, element_count, map_data};
use super::indexing::{MAX_ELEMENTS, axis_in, broadcast, broadcast_strides, strided, strides};

pub(super) fn reshape(x: &Array, shape: &[i64]) -> Option<Array> {
    let mut dims = Vec::with_capacity(shape.len());
    let mut open = None;
    for (axis, &dim) in shape.iter().enumerate() {
        dims.push(match dim {
            -1 if open.is_none() => {
                open = Some(axis);
                1
            }
            0 => *x.dims().get(axis)?,
            dim => usize::try_from(dim).ok()?,
        });
    }
    if let Some(axis) = open {
        dims[axis] = x.data().len().checked_div(element_count(&dims)?)?;
    }
    x.clone().reshaped(dims)
}

pub(super) fn squeeze(x: &Array, axes: &[i64]) -> Option<Array> {
    let rank = x.dims().len();
    let axes: Option<Vec<usize>> = axes.iter().map(|&axis| axis_in(axis, rank)).collect();
    let axes = axes?;
    let kept = x.dims().iter().enumerate().filter(|(axis, _)| !axes.contains(axis));
    x.clone().reshaped(kept.map(|(_, &dim)| dim).collect())
}

pub(super) fn unsqueeze(x: &Array, axes: &[i64]) -> Option<Array> {
    let rank = x.dims().len() + axes.len();
    let axes: Option<Vec<usize>> = axes.iter().map(|&axis| axis_in(axis, rank)).collect();
    let axes = axes?;
    let mut dims = x.dims().iter().copied();
    let dims: Option<Vec<usize>> =
        (0..rank).map(|axis| if axes.contains(&axis) { Some(1) } else { dims.next() }).collect();
    x.clone().reshaped(dims?)
}

/// Returns an array with its own elements read through strides.
fn viewed(x: &Array, dims: Vec<usize>, strides: &[isize], offset: usize) -> Option<Array> {
    let data = map_data!(x.data(), values => strided(values, &dims, strides, offset)?);
    Array::new(dims, data).map(Array::completed)
}

pub(super) fn transpose(x: &Array, perm: &[i64]) -> Option<Array> {
    let rank = x.dims().len();
    let own = strides(x.dims());
    let perm: Option<Vec<usize>> = perm.iter().map(|&axis| axis_in(axis, rank)).collect();
    let perm = perm.filter(|perm| perm.len() == rank)?;
    let dims = perm.iter().map(|&axis| x.dims()[axis]).collect();
    let strides: Vec<isize> = perm.iter().map(|&axis| own[axis] as isize).collect();
    viewed(x, dims, &strides, 0)
}

pub(super) fn expand(x: &Array, shape: &[i64]) -> Option<Array> {
    let shape: Option<Vec<usize>> = shape.iter().map(|&dim| usize::try_from(dim).ok()).collect();
    let dims = broadcast(x.dims(), &shape?)?;
    let strides = broadcast_strides(x.dims(), &dims)?;
    viewed(x, dims, &strides, 0)
}

pub(super) fn tile(x: &Array, repeats: &[i64]) -> Option<Array> {
    let mut result = x.clone();
    for (axis, &repeat) in repeats.iter().enumerate() {
        let repeat = usize::try_from(repeat).ok()?;
        if repeat.checked_mul(result.data().len())? > MAX_ELEMENTS {
            return None;
        }
        if repeat != 1 {
            result = concat(&vec![&result; repeat], axis as i64)?;
        }
    }
    Some(result)
}

pub(super) fn slice(x: &Array, starts: &[i64], ends: &[i64], axes: &[i64], steps: &[i64]) -> Option<Array> {
    let mut dims = x.dims().to_vec();
    let mut strides: Vec<isize> = strides(x.dims()).into_iter().map(|stride| stride as isize).collect();
    let mut offset = 0;
    for (i, &axis) in axes.iter().enumerate() {
        let axis = axis_in(axis, dims.len())?;
        let (start, count) = slice_range(x.dims()[axis], *starts.get(i)?, *ends.get(i)?, *steps.get(i)?)?;
        offset += start * strides[axis].unsigned_abs();
        dims[axis] = count;
        strides[axis] = strides[axis].checked_mul(isize::try_from(*steps.get(i)?).ok()?)?;
    }
    viewed(x, dims, &strides, offset)
}

/// Returns the first index and the number of elements of `start..end` by `step` on an axis of `dim` elements, by the
/// rules of ONNX's `Slice`: negative positions count from the end, all are clamped.
pub fn slice_range(dim: usize, start: i64, end: i64, step: i64) -> Option<(usize, usize)> {
    let dim = i64::try_from(dim).ok()?;
    if dim == 0 {
        return Some((0, 0));
    }
    let absolute = |position: i64| if position < 0 { position.saturating_add(dim) } else { position };
    let (start, end) = if step > 0 {
        (absolute(start).clamp(0, dim), absolute(end).clamp(0, dim))
    } else {
        (absolute(start).clamp(0, dim - 1), absolute(end).clamp(-1, dim - 1))
    };
    let span = if step > 0 { end - start } else { start - end }.max(0) as u64;
    let count = span.div_ceil(if step == 0 { return None } else { step.unsigned_abs() });
    Some((if count == 0 { 0 } else { usize::try_from(start).ok()? }, count as usize))
}

pub(super) fn gather(x: &Array, indices: &Array, axis: i64) -> Option<Array> {
    let axis = axis_in(axis, x.dims().len())?;
    let dim = x.dims()[axis];
    let picks: Option<Vec<usize>> = indices.as_ints()?.iter().map(|&index| axis_in(index, dim)).collect();
    let picks = picks?;
    let outer = element_count(&x.dims()[..axis])?;
    let inner = element_count(&x.dims()[axis + 1..])?;
    if outer.checked_mul(inner)?.checked_mul(picks.len())? > MAX_ELEMENTS {
        return None;
    }
    let data = map_data!(x.data(), values => (0..outer)
        .flat_map(|block| picks.iter().map(move |pick| (block * dim + pick) * inner))
        .flat_map(|first| values[first..first + inner].iter().copied())
        .collect());
    let dims = [&x.dims()[..axis], indices.dims(), &x.dims()[axis + 1..]].concat();
    Array::new(dims, data).map(Array::completed)
}

pub(super) fn concat(parts: &[&Array], axis: i64) -> Option<Array> {
    let first = parts.first()?;
    let axis = axis_in(axis, first.dims().len())?;
    let outer = element_count(&first.dims()[..axis])?;
    let mut dims = first.dims().to_vec();
    dims[axis] = parts.iter().try_fold(0usize, |sum, part| sum.checked_add(*part.dims().get(axis)?))?;
    if element_count(&dims)? > MAX_ELEMENTS {
        return None;
    }
    let mut data: Option<Data> = None;
    let partial = parts.iter().any(|part| !part.is_complete());
    for block in 0..outer {
        for part in parts {
            let size = part.data().len().checked_div(outer)?;
            let range = block * size..(block + 1) * size;
            match (&mut data, part.data()) {
                (None, values) if partial => {
                    data = Some(Data::Partial(partial_values(values)?.get(range)?.to_vec()))
                }
                (Some(Data::Partial(all)), values) => all.extend(partial_values(values)?.get(range)?),
                (None, values) => data = Some(map_data!(values, values => values.get(range)?.to_vec())),
                (Some(Data::Float(all)), Data::Float(values)) => all.extend(values.get(range)?),
                (Some(Data::Int(all)), Data::Int(values)) => all.extend(values.get(range)?),
                (Some(Data::Bool(all)), Data::Bool(values)) => all.extend(values.get(range)?),
                _ => return None,
            }
        }
    }
    Array::new(dims, data?).map(Array::completed)
}

/// Returns integers as integers that may be unknown.
pub(super) fn partial_values(data: &Data) -> Option<Vec<Option<i64>>> {
    match data {
        Data::Int(values) => Some(values.iter().copied().map(Some).collect()),
        Data::Partial(values) => Some(values.clone()),
        _ => None,
    }
}

pub(super) fn split(x: &Array, sizes: &[i64], axis: i64) -> Option<Vec<Array>> {
    let axis = axis_in(axis, x.dims().len())? as i64;
    let mut start = 0i64;
    let mut parts = Vec::with_capacity(sizes.len());
    for &size in sizes {
        let end = start.checked_add(size)?;
        parts.push(slice(x, &[start], &[end], &[axis], &[1])?);
        start = end;
    }
    Some(parts)
}

pub(super) fn scatter_nd(x: &Array, indices: &Array, updates: &Array) -> Option<Array> {
    let depth = *indices.dims().last()?;
    let inner = element_count(x.dims().get(depth..)?)?;
    let own = strides(x.dims());
    let mut result = x.clone();
    let rows = indices.as_ints()?.chunks_exact(depth.max(1));
    for (row, index) in rows.enumerate() {
        let mut first = 0;
        for (axis, &position) in index.iter().enumerate() {
            first += axis_in(position, x.dims()[axis])? * own[axis];
        }
        let (to, from) = (first..first + inner, row * inner..(row + 1) * inner);
        match (result.data_mut(), updates.data()) {
            (Data::Float(all), Data::Float(new)) => all.get_mut(to)?.copy_from_slice(new.get(from)?),
            (Data::Int(all), Data::Int(new)) => all.get_mut(to)?.copy_from_slice(new.get(from)?),
            _ => return None,
        }
    }
    Some(result)
}
