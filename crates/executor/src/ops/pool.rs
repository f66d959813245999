//! Pooling.

use opendr_engine::Result;
use opendr_kernels::{Binary, Window};
use opendr_onnx::proto::NodeProto;

use super::conv::{output_shape, window};
use super::required;
use crate::attributes::Attributes;
use crate::io::Io;
use crate::planner::{Id, Kernel, Layout, Planner};
use crate::tensor::{Kind, count};

pub(crate) fn pool(planner: &mut Planner<'_>, node: &NodeProto, inputs: &[Option<Id>]) -> Result<Vec<Id>> {
    let x = required(node, inputs, 0)?;
    let dims = planner.shape(x);
    if planner.kind(x) != Kind::F32 || !(3..=4).contains(&dims.len()) || node.output.get(1).is_some_and(|name| !name.is_empty()) {
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
        PoolKind::Max
    } else if node.int_or("count_include_pad", 0) != 0 {
        PoolKind::MeanWithPadding { pads_after }
    } else {
        PoolKind::Mean
    };
    if matches!(kind, PoolKind::MeanWithPadding { .. }) && node.text("auto_pad", "NOTSET") != "NOTSET" {
        return Err(node.refused("padding that is counted and automatic"));
    }
    let step = PoolStep { kind, window, channels: dims[1] };
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

#[derive(Debug, Clone, Copy, PartialEq)]
enum PoolKind {
    Max,
    Mean,
    MeanWithPadding { pads_after: [usize; 2] },
}

struct PoolStep {
    kind: PoolKind,
    window: Window,
    channels: usize,
}

impl Kernel for PoolStep {
    fn run(&self, io: &mut Io<'_>) -> Result<()> {
        let (x, y) = (io.read::<f32>(0), io.write::<f32>());
        let Window { kernel, strides, dilations, pads, input, output } = self.window;
        let channels = self.channels;
        if y.is_empty() {
            return Ok(());
        }
        let isa = io.compute.isa();
        let row_length = output[1] * channels;
        let function = if self.kind == PoolKind::Max { Binary::Max } else { Binary::Add };
        io.compute.pool().run_on_pieces(y, row_length, |index, y| {
            let (image, oy) = (index / output[0], index % output[0]);
            let range = |at: usize, axis: usize| {
                let start = (at * strides[axis]) as isize - pads[axis] as isize;
                let inside = |k: &usize| {
                    let at = start + (k * dilations[axis]) as isize;
                    at >= 0 && at < input[axis] as isize
                };
                (start, (0..kernel[axis]).filter(inside).count(), (0..kernel[axis]).find(inside).unwrap_or(0))
            };
            let (top, rows, first_row) = range(oy, 0);
            for (ox, y) in y.chunks_exact_mut(channels).enumerate() {
                let (left, columns, first_column) = range(ox, 1);
                let mut is_first = true;
                for ky in first_row..first_row + rows {
                    let iy = (top + (ky * dilations[0]) as isize) as usize;
                    for kx in first_column..first_column + columns {
                        let ix = (left + (kx * dilations[1]) as isize) as usize;
                        let x = &x[((image * input[0] + iy) * input[1] + ix) * channels..][..channels];
                        if is_first {
                            y.copy_from_slice(x);
                            is_first = false;
                        } else {
                            function.apply_to(isa, y, x);
                        }
                    }
                }
                if is_first {
                    y.fill(if self.kind == PoolKind::Max { f32::NEG_INFINITY } else { 0.0 });
                }
                let taps = match self.kind {
                    PoolKind::Max => continue,
                    PoolKind::Mean => rows * columns,
                    PoolKind::MeanWithPadding { pads_after } => {
                        let counted = |start: isize, axis: usize| {
                            let end = (input[axis] + pads_after[axis]) as isize;
                            (0..kernel[axis]).filter(|k| start + ((k * dilations[axis]) as isize) < end).count()
                        };
                        counted(top, 0) * counted(left, 1)
                    }
                };
                let scale = 1.0 / taps.max(1) as f32;
                Binary::Mul.apply_scalar(isa, y, scale);
            }
        });
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
