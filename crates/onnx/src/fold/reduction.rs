//! Reductions over axes: sum, product, mean, minimum, maximum.

use super::super::array::{Array, Data, element_count};
use super::super::operator::Operator;
use super::indexing::{axis_in, strided, strides};

type IntFold = fn(i64, i64) -> Option<i64>;

pub(super) fn reduce(operator: &Operator, x: &Array, axes: &[i64]) -> Option<Array> {
    let rank = x.dims().len();
    let axes: Option<Vec<usize>> = axes.iter().map(|&axis| axis_in(axis, rank)).collect();
    let axes = axes?;
    // Stride of the reduced array per axis of `x`: zero on reduced axes.
    let kept: Vec<usize> =
        (0..rank).map(|axis| if axes.contains(&axis) { 1 } else { x.dims()[axis] }).collect();
    let own = strides(&kept);
    let strides: Vec<isize> =
        (0..rank).map(|axis| if axes.contains(&axis) { 0 } else { own[axis] as isize }).collect();
    let targets: Vec<usize> = (0..element_count(&kept)?).collect();
    let targets = strided(&targets, x.dims(), &strides, 0)?;
    let name = operator.name();
    let data = match x.data() {
        Data::Float(values) => {
            let (first, f): (f32, fn(f32, f32) -> f32) = match name {
                "ReduceSum" | "ReduceMean" => (0.0, |a, b| a + b),
                "ReduceProd" => (1.0, |a, b| a * b),
                "ReduceMax" => (f32::NEG_INFINITY, f32::max),
                _ => (f32::INFINITY, f32::min),
            };
            let mut result = vec![first; element_count(&kept)?];
            targets.iter().zip(values).for_each(|(&at, &value)| result[at] = f(result[at], value));
            if name == "ReduceMean" {
                let share = result.len() as f32 / values.len() as f32;
                result.iter_mut().for_each(|value| *value *= share);
            }
            Data::Float(result)
        }
        Data::Int(values) => {
            let (first, f): (i64, IntFold) = match name {
                "ReduceSum" => (0, i64::checked_add),
                "ReduceProd" => (1, i64::checked_mul),
                "ReduceMax" => (i64::MIN, |a, b| Some(a.max(b))),
                "ReduceMin" => (i64::MAX, |a, b| Some(a.min(b))),
                _ => return None,
            };
            let mut result = vec![first; element_count(&kept)?];
            for (&at, &value) in targets.iter().zip(values) {
                result[at] = f(result[at], value)?;
            }
            Data::Int(result)
        }
        _ => return None,
    };
    let keep = operator.get_int("keepdims").unwrap_or(1) != 0;
    let dims = match keep {
        true => kept,
        false => (0..rank).filter(|axis| !axes.contains(axis)).map(|axis| x.dims()[axis]).collect(),
    };
    Array::new(dims, data)
}
