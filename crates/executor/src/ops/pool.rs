//! Pooling.

use opendr_engine::Result;
use opendr_kernels::{Binary, Pooling, Window};
use opendr_onnx::proto::NodeProto;

use super::conv::{output_shape, window};
use super::inputs::required;
use crate::attributes::Attributes;
use crate::io::{Io, Kernel};
use crate::planner::{Id, Layout, Planner};
use crate::tensor::{Kind, count};

pub(crate) fn pool(planner: &mut Planner<'_>, node: &NodeProto, inputs: &[Option<Id>]) -> Result<Vec<Id>> {
    let x = required(node, inputs, 0)?;
    let dims = planner.shape(x);
    if planner.kind(x) != Kind::F32
        || !(3..=4).contains(&dims.len())
        || node.output.get(1).is_some_and(|name| !name.is_empty())
    {
        return Err(node.refused("its input or its outputs"));
    }
    let rank = dims.len() - 2;
    let kernel = node.sizes("kernel_shape", rank, 0)?;
    let window = window(node, &dims[2..], &kernel, node.int_or("ceil_mode", 0) != 0)?;
    let x = planner.channels_last(x)?;
    let shape = output_shape(&window, dims[0], dims[1], rank);
    let mut pads_after = [0; 2];
    let pads = node.sizes("pads", 2 * rank, 0)?;
    pads_after[2 - rank..].copy_from_slice(&pads[rank..]);
    let kind = if node.op_type == "MaxPool" {
        Pooling::Max
    } else if node.int_or("count_include_pad", 0) != 0 {
        Pooling::MeanWithPadding { pads_after }
    } else {
        Pooling::Mean
    };
    if matches!(kind, Pooling::MeanWithPadding { .. }) && node.text("auto_pad", "NOTSET") != "NOTSET" {
        return Err(node.refused("padding that is counted and automatic"));
    }
    let step = PoolStep { pooling: kind, window, batch: dims[0], channels: dims[1] };
    Ok(vec![planner.emit_one(step, &[x], Kind::F32, shape, Layout::ChannelsLast)?])
}

pub(crate) fn global(planner: &mut Planner<'_>, node: &NodeProto, inputs: &[Option<Id>]) -> Result<Vec<Id>> {
    let x = required(node, inputs, 0)?;
    let dims = planner.shape(x);
    if planner.kind(x) != Kind::F32 || dims.len() < 3 {
        return Err(node.refused("its input"));
    }
    let x = planner.channels_last(x)?;
    let pixels = count(&dims[2..])?;
    let mut shape = vec![1; dims.len()];
    shape[..2].copy_from_slice(&dims[..2]);
    let step = GlobalStep { pixels, channels: dims[1], is_mean: node.op_type == "GlobalAveragePool" };
    Ok(vec![planner.emit_one(step, &[x], Kind::F32, shape, Layout::ChannelsLast)?])
}

struct PoolStep {
    pooling: Pooling,
    window: Window,
    batch: usize,
    channels: usize,
}

impl Kernel for PoolStep {
    fn run(&self, io: &mut Io<'_>) -> Result<()> {
        let x = io.read::<f32>(0);
        let y = io.write();
        self.pooling.run(io.compute, &self.window, self.batch, self.channels, x, y);
        Ok(())
    }
}

struct GlobalStep {
    pixels: usize,
    channels: usize,
    is_mean: bool,
}

impl Kernel for GlobalStep {
    fn run(&self, io: &mut Io<'_>) -> Result<()> {
        let (x, y) = (io.read::<f32>(0), io.write::<f32>());
        let isa = io.compute.isa();
        let channels = self.channels.max(1);
        for (y, x) in y.chunks_mut(channels).zip(x.chunks((self.pixels * channels).max(1))) {
            let mut pixels = x.chunks_exact(channels);
            match pixels.next() {
                Some(first) => y.copy_from_slice(first),
                None => y.fill(f32::NAN),
            }
            let function = if self.is_mean { Binary::Add } else { Binary::Max };
            pixels.for_each(|x| function.apply_to(isa, y, x));
            if self.is_mean {
                Binary::Mul.apply_scalar(isa, y, 1.0 / self.pixels.max(1) as f32);
            }
        }
        Ok(())
    }
}
