//! Inputs of nodes.

use opendr_engine::Result;
use opendr_onnx::proto::NodeProto;

use crate::attributes::Attributes;
use crate::planner::{Id, Planner};

/// Returns a required input.
pub(crate) fn required(node: &NodeProto, inputs: &[Option<Id>], slot: usize) -> Result<Id> {
    inputs.get(slot).copied().flatten().ok_or_else(|| node.damaged(&format!("it has no input {slot}")))
}

/// Returns an optional input.
pub(crate) fn optional(inputs: &[Option<Id>], slot: usize) -> Option<Id> {
    inputs.get(slot).copied().flatten()
}

/// Returns an axis that may be negative.
pub(crate) fn axis(node: &NodeProto, axis: i64, rank: usize) -> Result<usize> {
    let rank_signed = i64::try_from(rank).unwrap_or(i64::MAX);
    let index = if axis < 0 { axis.saturating_add(rank_signed) } else { axis };
    usize::try_from(index)
        .ok()
        .filter(|&index| index < rank)
        .ok_or_else(|| node.damaged(&format!("axis {axis} of a tensor of {rank} dimensions")))
}

/// Returns a list from an attribute or an input, in that order.
pub(crate) fn list(
    planner: &Planner<'_>,
    node: &NodeProto,
    inputs: &[Option<Id>],
    key: &str,
    slot: usize,
) -> Result<Option<Vec<i64>>> {
    match (node.ints(key), optional(inputs, slot)) {
        (Some(values), _) => Ok(Some(values.to_vec())),
        (None, Some(id)) => Ok(Some(planner.ints(node, id)?)),
        (None, None) => Ok(None),
    }
}
