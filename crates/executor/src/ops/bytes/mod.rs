//! Operators between a dequantisation and a quantisation, which compute with the bytes themselves.
//!
//! What does not match one of the patterns is computed in floats, as the model states.

pub(super) mod conv;
mod pattern;
pub(super) mod pool;
pub(super) mod resize;
pub(super) mod sum;
pub(super) mod table;

use opendr_engine::Result;
use opendr_onnx::proto::NodeProto;

use crate::planner::{Id, Planner};

/// Finds the largest byte instead of the largest number that it stands for.
pub(super) fn labels(planner: &mut Planner<'_>, node: &NodeProto) -> Result<Option<Vec<Id>>> {
    let Some(x) = node.input.first().and_then(|name| pattern::dequantised(planner, name)) else {
        return Ok(None);
    };
    super::reduce::arg(planner, node, &[Some(x.bytes)]).map(Some)
}
