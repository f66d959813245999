//! Axes, strides and broadcasting.

use super::super::array::element_count;

/// Maximum number of elements of a result; a small node of a hostile file could otherwise request gigabytes.
pub(super) const MAX_ELEMENTS: usize = 1 << 24;

/// Returns row-major strides; dimensions of an [`Array`](super::super::array::Array) never overflow.
pub(super) fn strides(dims: &[usize]) -> Vec<usize> {
    let mut strides = vec![1; dims.len()];
    for axis in (1..dims.len()).rev() {
        strides[axis - 1] = strides[axis] * dims[axis];
    }
    strides
}

/// Resolves an axis; a negative one counts from the end.
pub(super) fn axis_in(axis: i64, rank: usize) -> Option<usize> {
    let axis = if axis < 0 { axis.checked_add(rank as i64)? } else { axis };
    usize::try_from(axis).ok().filter(|&axis| axis < rank)
}

/// Reads `dims` elements from `offset` on with `strides`; every position must be inside `source`.
pub(super) fn strided<T: Clone>(
    source: &[T],
    dims: &[usize],
    strides: &[isize],
    offset: usize,
) -> Option<Vec<T>> {
    let count = element_count(dims).filter(|&count| count <= MAX_ELEMENTS)?;
    let mut result = Vec::with_capacity(count);
    let mut index = vec![0usize; dims.len()];
    let mut position = offset as isize;
    for _ in 0..count {
        result.push(source.get(usize::try_from(position).ok()?)?.clone());
        for axis in (0..dims.len()).rev() {
            index[axis] += 1;
            // Wraps only on steps longer than the axis, which are undone below.
            position = position.wrapping_add(strides[axis]);
            if index[axis] < dims[axis] {
                break;
            }
            position = position.wrapping_sub(strides[axis].wrapping_mul(dims[axis] as isize));
            index[axis] = 0;
        }
    }
    Some(result)
}

/// Returns the dimensions of NumPy broadcasting; `None` when they are incompatible.
pub fn broadcast(a: &[usize], b: &[usize]) -> Option<Vec<usize>> {
    let rank = a.len().max(b.len());
    let dim = |dims: &[usize], axis: usize| (axis + dims.len()).checked_sub(rank).map_or(1, |i| dims[i]);
    (0..rank)
        .map(|axis| match (dim(a, axis), dim(b, axis)) {
            (x, y) if x == y => Some(x),
            (1, y) => Some(y),
            (x, 1) => Some(x),
            _ => None,
        })
        .collect()
}

/// Returns strides that broadcast an array of dimensions `dims` to dimensions `target`.
pub(super) fn broadcast_strides(dims: &[usize], target: &[usize]) -> Option<Vec<isize>> {
    let missing = target.len().checked_sub(dims.len())?;
    let own = strides(dims);
    let mut result = vec![0isize; missing];
    for (axis, &dim) in dims.iter().enumerate() {
        match dim {
            1 => result.push(0),
            _ if dim == target[missing + axis] => result.push(own[axis] as isize),
            _ => return None,
        }
    }
    Some(result)
}
