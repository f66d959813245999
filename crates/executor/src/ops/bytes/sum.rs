//! Sums of tensors of bytes.

use opendr_engine::Result;
use opendr_kernels::ByteSum;
use opendr_onnx::proto::NodeProto;

use super::pattern::{dequantised, requantised};
use crate::io::{Io, Kernel};
use crate::planner::{Id, Layout, Planner};

pub(crate) fn build(planner: &mut Planner<'_>, node: &NodeProto) -> Result<Option<Vec<Id>>> {
    let [a, b] = node.input.as_slice() else { return Ok(None) };
    let (Some(a), Some(b)) = (dequantised(planner, a), dequantised(planner, b)) else { return Ok(None) };
    let Some(after) = requantised(planner, node) else { return Ok(None) };
    let shape = planner.shape(a.bytes);
    let ratios = [a.scale / after.scale, b.scale / after.scale];
    if shape != planner.shape(b.bytes) || !ratios.iter().all(|ratio| ratio.is_finite()) {
        return Ok(None);
    }
    let last = planner.is_channels_last(a.bytes) || planner.is_channels_last(b.bytes);
    let mut reads = Vec::new();
    for id in [a.bytes, b.bytes] {
        reads.push(if last { planner.channels_last(id)? } else { planner.plain(id)? });
    }
    let layout = if last { Layout::ChannelsLast } else { Layout::Plain };
    let step = SumStep(ByteSum { terms: [(a.zero, ratios[0]), (b.zero, ratios[1])], output: after.output });
    let y = planner.emit_one(step, &reads, after.kind(), shape, layout)?;
    after.absorb(planner, y);
    Ok(Some(vec![y]))
}

struct SumStep(ByteSum);

impl Kernel for SumStep {
    fn run(&self, io: &mut Io<'_>) -> Result<()> {
        let (a, b) = (io.read::<u8>(0), io.read::<u8>(1));
        self.0.run(io.compute, [a, b], io.write());
        Ok(())
    }
}
