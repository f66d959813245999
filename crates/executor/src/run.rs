//! What a run has besides the graph: memory, and a bound on loops.

use opendr_engine::{Error, Result};
use opendr_kernels::{Arena, Compute, LayerCost};
use opendr_onnx::proto::NodeProto;

/// Bytes of all tensors of the iterations of loops in a run, beyond which the run ends with an error.
const MAX_LOOP_BYTES: u64 = 1 << 40;

/// Bytes that an iteration counts at least.
const MIN_LOOP_BYTES: u64 = 1 << 20;

/// Receives the node that has run, and its arithmetic, weights, and bytes of tensors, which are computed when called.
pub(crate) type Observe<'a> = dyn FnMut(&NodeProto, &dyn Fn() -> (LayerCost, u64)) + 'a;

/// What a run needs besides the graph.
pub(crate) struct Run<'a> {
    pub(crate) arena: &'a mut Arena,
    pub(crate) compute: &'a Compute,
    /// Bytes of the iterations of loops so far.
    pub(crate) looped: u64,
    /// Called after each step and each node that is not planned.
    pub(crate) observe: &'a mut Observe<'a>,
}

impl Run<'_> {
    /// Counts an iteration of a loop.
    ///
    /// # Errors
    /// `Unsupported` where the loops of the run have taken too long.
    pub(crate) fn count_iteration(&mut self) -> Result<()> {
        let bytes = (self.arena.bytes() as u64).max(MIN_LOOP_BYTES);
        self.looped = self.looped.saturating_add(bytes);
        if self.looped > MAX_LOOP_BYTES {
            return Err(Error::unsupported("the loops of the ONNX model do not end"));
        }
        Ok(())
    }
}
