//! Means of whole images of bytes.

use opendr_engine::Result;
use opendr_kernels::{ByteOutput, add_byte_rows};
use opendr_onnx::proto::NodeProto;

use super::pattern::{dequantised, requantised};
use crate::attributes::Attributes;
use crate::io::{Io, Kernel};
use crate::planner::{Id, Layout, Planner};
use crate::tensor::{Kind, count};

pub(crate) fn build(planner: &mut Planner<'_>, node: &NodeProto) -> Result<Option<Vec<Id>>> {
    let Some(x) = node.input.first().and_then(|name| dequantised(planner, name)) else { return Ok(None) };
    let Some(after) = requantised(planner, node) else { return Ok(None) };
    let dims = planner.shape(x.bytes);
    let pixels = dims.iter().skip(2).product::<usize>();
    if !(3..=4).contains(&dims.len()) || pixels == 0 || pixels > 1 << 23 || dims[1] == 0 {
        return Ok(None);
    }
    let rank = dims.len() - 2;
    let is_whole = node.op_type == "GlobalAveragePool"
        || (node.sizes("kernel_shape", rank, 0)? == dims[2..]
            && node.sizes("pads", 2 * rank, 0)?.iter().all(|&pad| pad == 0)
            && node.text("auto_pad", "NOTSET") != "SAME_UPPER"
            && node.text("auto_pad", "NOTSET") != "SAME_LOWER"
            && node.sizes("dilations", rank, 1)?.iter().all(|&dilation| dilation == 1));
    let scale = x.scale / (after.scale * pixels as f32);
    if !is_whole || !scale.is_finite() {
        return Ok(None);
    }
    let mut shape = vec![1; dims.len()];
    shape[..2].copy_from_slice(&dims[..2]);
    count(&shape)?;
    let bytes = planner.channels_last(x.bytes)?;
    let step = AddStep { channels: dims[1], pixels, is_signed: x.zero.is_signed };
    let sums = planner.emit_one(step, &[bytes], Kind::I32, shape.clone(), Layout::ChannelsLast)?;
    let offset = x.zero.zero * pixels as i32;
    let step = ScaleStep { offset, scale, output: after.output };
    let y = planner.emit_one(step, &[sums], after.kind(), shape, Layout::ChannelsLast)?;
    after.absorb(planner, y);
    Ok(Some(vec![y]))
}

struct AddStep {
    channels: usize,
    pixels: usize,
    is_signed: bool,
}

impl Kernel for AddStep {
    fn run(&self, io: &mut Io<'_>) -> Result<()> {
        let (x, y) = (io.read::<u8>(0), io.write::<i32>());
        y.fill(0);
        for (y, x) in y.chunks_mut(self.channels).zip(x.chunks(self.pixels * self.channels)) {
            add_byte_rows(io.compute, x, self.is_signed, y);
        }
        Ok(())
    }
}

struct ScaleStep {
    offset: i32,
    scale: f32,
    output: ByteOutput,
}

impl Kernel for ScaleStep {
    fn run(&self, io: &mut Io<'_>) -> Result<()> {
        let (x, y) = (io.read::<i32>(0), io.write::<u8>());
        for (y, &x) in y.iter_mut().zip(x) {
            let rounded = ((x - self.offset) as f32 * self.scale).round_ties_even() as i32;
            let byte = rounded.saturating_add(self.output.zero.zero);
            *y = byte.clamp(self.output.low, self.output.high) as u8;
        }
        Ok(())
    }
}
