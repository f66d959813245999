//! Broadcasting: the shape and layout of a result, and its rows in each operand.

use opendr_engine::Result;
use opendr_onnx::proto::NodeProto;

use crate::attributes::Attributes;
use crate::planner::{Id, Layout, Planner};
use crate::tensor::count;

/// Returns the shape that several ones broadcast to.
pub(crate) fn broadcast_shape(node: &NodeProto, shapes: &[Vec<usize>]) -> Result<Vec<usize>> {
    let rank = shapes.iter().map(Vec::len).max().unwrap_or(0);
    let mut all = vec![1; rank];
    for shape in shapes {
        for (to, &dim) in all[rank - shape.len()..].iter_mut().zip(shape) {
            match (*to, dim) {
                (_, 1) => {}
                (1, _) => *to = dim,
                (to, dim) if to == dim => {}
                _ => return Err(node.damaged(&format!("shapes {shapes:?} do not broadcast"))),
            }
        }
    }
    count(&all)?;
    Ok(all)
}

/// Brings operands to one layout; returns them with the shape and the layout of the result.
pub(super) fn aligned(
    planner: &mut Planner<'_>,
    node: &NodeProto,
    ids: &[Id],
) -> Result<(Vec<Id>, Vec<usize>, Layout)> {
    let shapes: Vec<Vec<usize>> = ids.iter().map(|&id| planner.shape(id)).collect();
    let shape = broadcast_shape(node, &shapes)?;
    let rank = shape.len();
    let last = rank > 2 && ids.iter().any(|&id| planner.is_channels_last(id) && planner.rank(id) == rank);
    let mut laid = Vec::new();
    for &id in ids {
        laid.push(if !last || shapes.is_empty() {
            planner.plain(id)?
        } else if planner.rank(id) == rank {
            planner.channels_last(id)?
        } else {
            let plain = planner.plain(id)?;
            let mut dims = vec![1; rank - planner.rank(plain)];
            dims.extend(planner.shape(plain));
            let wide = planner.alias(plain, dims, Layout::Plain);
            planner.channels_last(wide)?
        });
    }
    Ok((laid, shape, if last { Layout::ChannelsLast } else { Layout::Plain }))
}

/// Rows of a result, and where they begin in each operand.
#[derive(Debug)]
pub(crate) struct Rows {
    /// Length and strides of the outer dimensions.
    outer: Vec<(usize, Vec<usize>)>,
    pub(crate) length: usize,
    /// Per operand, whether it has a number for each element of a row, or one for all.
    pub(crate) is_row: Vec<bool>,
}

impl Rows {
    pub(crate) fn new(dims: &[usize], operands: &[Vec<usize>]) -> Self {
        let rank = dims.len();
        let strides: Vec<Vec<usize>> = operands
            .iter()
            .map(|shape| {
                let own = crate::remap::strides(shape);
                let missing = rank - shape.len();
                (0..rank)
                    .map(|d| d.checked_sub(missing).filter(|&d| shape[d] != 1).map_or(0, |d| own[d]))
                    .collect()
            })
            .collect();
        let mut merged: Vec<(usize, Vec<usize>)> = Vec::new();
        for (d, &length) in dims.iter().enumerate().filter(|(_, length)| **length != 1) {
            let steps: Vec<usize> = strides.iter().map(|strides| strides[d]).collect();
            match merged.last_mut() {
                Some((outer, outer_steps))
                    if outer_steps.iter().zip(&steps).all(|(outer, step)| *outer == step * length) =>
                {
                    *outer *= length;
                    *outer_steps = steps;
                }
                _ => merged.push((length, steps)),
            }
        }
        let (length, steps) = merged.pop().unwrap_or_else(|| (1, vec![1; operands.len()]));
        Self { outer: merged, length, is_row: steps.iter().map(|&step| step != 0).collect() }
    }

    /// Returns whether all elements are one row.
    pub(crate) fn is_one(&self) -> bool {
        self.outer.is_empty()
    }

    /// Returns the first element of a row in an operand.
    #[inline]
    pub(crate) fn start(&self, mut row: usize, operand: usize) -> usize {
        let mut at = 0;
        for (length, steps) in self.outer.iter().rev() {
            at += row % length * steps[operand];
            row /= length;
        }
        at
    }

    /// Returns the operand of two that is one row for all rows of the other, which lie side by side.
    pub(crate) fn repeated(&self) -> Option<usize> {
        let [(_, steps)] = self.outer.as_slice() else { return None };
        match steps[..] {
            [0, step] if step == self.length && self.is_row == [true, true] => Some(0),
            [step, 0] if step == self.length && self.is_row == [true, true] => Some(1),
            _ => None,
        }
    }

    /// Returns the elements of a row of an operand: as many as the row has, or one.
    #[inline]
    pub(crate) fn of<'a, T>(&self, x: &'a [T], row: usize, operand: usize, length: usize) -> &'a [T] {
        let start = self.start(row, operand);
        &x[start..start + if self.is_row[operand] { length } else { 1 }]
    }
}
