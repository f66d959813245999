//! Bilinear resizing of bytes.

use opendr_engine::Result;
use opendr_kernels::{ByteOutput, ByteResize};
use opendr_onnx::proto::NodeProto;

use super::super::resize::Geometry;
use super::pattern::{dequantised, requantised};
use crate::io::{Io, Kernel};
use crate::planner::{Id, Layout, Planner};

pub(crate) fn build(planner: &mut Planner<'_>, node: &NodeProto) -> Result<Option<Vec<Id>>> {
    let Some(x) = node.input.first().and_then(|name| dequantised(planner, name)) else { return Ok(None) };
    let Some(after) = requantised(planner, node) else { return Ok(None) };
    if after.scale != x.scale || after.output != ByteOutput::new(x.zero) {
        return Ok(None);
    }
    let mut inputs: Vec<Option<Id>> = node.input.iter().map(|name| planner.named(name)).collect();
    if let Some(first) = inputs.first_mut() {
        *first = Some(x.bytes);
    }
    let geometry = Geometry::new(planner, node, &inputs)?;
    if !geometry.is_linear {
        return Ok(None);
    }
    let fixed = |points: &[([usize; 2], f32)]| {
        points.iter().map(|&(at, weight)| (at, (weight * 1024.0) as i32)).collect::<Vec<_>>()
    };
    let channels = planner.shape(x.bytes)[1];
    let step = ResizeStep(ByteResize {
        rows: fixed(&geometry.rows),
        columns: fixed(&geometry.columns),
        input: geometry.input,
        channels,
        zero: x.zero,
    });
    let bytes = planner.channels_last(x.bytes)?;
    let y = planner.emit_one(step, &[bytes], after.kind(), geometry.shape, Layout::ChannelsLast)?;
    after.absorb(planner, y);
    Ok(Some(vec![y]))
}

struct ResizeStep(ByteResize);

impl Kernel for ResizeStep {
    fn run(&self, io: &mut Io<'_>) -> Result<()> {
        let x = io.read::<u8>(0);
        self.0.run(io.compute, x, io.write());
        Ok(())
    }
}
