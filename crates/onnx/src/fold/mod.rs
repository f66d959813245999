//! Constant folding: evaluation of operators with known inputs, so that shape arithmetic leaves no nodes.
//!
//! A function that returns `None` declines: the operator is then written into the graph and left to the runtime. No
//! function fails or panics, whatever the operands.

mod arithmetic;
mod movement;
mod reduction;

pub use movement::slice_range;

use super::array::{Array, element_count};
use super::operator::Operator;

/// Maximum number of elements of a result; a small node of a hostile file could otherwise request gigabytes.
const MAX_ELEMENTS: usize = 1 << 24;

/// Returns row-major strides; dimensions of an [`Array`] never overflow.
fn strides(dims: &[usize]) -> Vec<usize> {
    let mut strides = vec![1; dims.len()];
    for axis in (1..dims.len()).rev() {
        strides[axis - 1] = strides[axis] * dims[axis];
    }
    strides
}

/// Resolves an axis; a negative one counts from the end.
fn axis_in(axis: i64, rank: usize) -> Option<usize> {
    let axis = if axis < 0 { axis.checked_add(rank as i64)? } else { axis };
    usize::try_from(axis).ok().filter(|&axis| axis < rank)
}

/// Reads `dims` elements from `offset` on with `strides`; every position must be inside `source`.
fn strided<T: Clone>(source: &[T], dims: &[usize], strides: &[isize], offset: usize) -> Option<Vec<T>> {
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
fn broadcast_strides(dims: &[usize], target: &[usize]) -> Option<Vec<isize>> {
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

/// Returns the outputs of `operator`, if it can be evaluated and all required inputs are known. An absent optional
/// input is `None`.
pub fn evaluate(operator: &Operator, inputs: &[Option<&Array>]) -> Option<Vec<Array>> {
    let input = |i: usize| inputs.get(i).copied().flatten();
    let ints = |i: usize| input(i).and_then(Array::as_ints);
    let x = input(0)?;
    let result = match operator.name() {
        "Identity" => x.clone(),
        "Reshape" => movement::reshape(x, ints(1)?)?,
        "Squeeze" => movement::squeeze(x, ints(1)?)?,
        "Unsqueeze" => movement::unsqueeze(x, ints(1)?)?,
        "Transpose" => movement::transpose(x, operator.get_ints("perm")?)?,
        "Expand" => movement::expand(x, ints(1)?)?,
        "Tile" => movement::tile(x, ints(1)?)?,
        "Slice" => movement::slice(x, ints(1)?, ints(2)?, ints(3)?, ints(4)?)?,
        "Gather" => movement::gather(x, input(1)?, operator.get_int("axis").unwrap_or(0))?,
        "Concat" => {
            let parts: Option<Vec<&Array>> = inputs.iter().copied().collect();
            movement::concat(&parts?, operator.get_int("axis")?)?
        }
        "Split" => return movement::split(x, ints(1)?, operator.get_int("axis").unwrap_or(0)),
        "ScatterND" => movement::scatter_nd(x, input(1)?, input(2)?)?,
        "Range" => arithmetic::range(x, input(1)?, input(2)?)?,
        "Cast" => arithmetic::cast(x, operator.get_int("to")?)?,
        "Where" => arithmetic::select(x, input(1)?, input(2)?)?,
        "ReduceSum" => reduction::reduce(operator, x, ints(1)?)?,
        "ReduceMax" | "ReduceMin" | "ReduceProd" | "ReduceMean" => {
            reduction::reduce(operator, x, operator.get_ints("axes")?)?
        }
        name => match input(1) {
            Some(y) => arithmetic::binary(name, x, y)?,
            None => arithmetic::unary(name, x)?,
        },
    };
    Some(vec![result])
}

#[cfg(test)]
mod tests;
