//! Convolutions of bytes, as sums of 32 bits.

use std::sync::Arc;

use opendr_engine::Result;
use opendr_kernels::{LayerCost, Window};
use opendr_onnx::proto::NodeProto;

use super::conv::{output_shape, window};
use super::inputs::required;
use super::matmul_integer::{number, numbers, zero};
use crate::attributes::Attributes;
use crate::constant::Constant;
use crate::io::{Io, Kernel};
use crate::planner::{Id, Layout, Planner};
use crate::tensor::{Kind, count};

pub(crate) fn build(planner: &mut Planner<'_>, node: &NodeProto, inputs: &[Option<Id>]) -> Result<Vec<Id>> {
    let (x, w) = (required(node, inputs, 0)?, required(node, inputs, 1)?);
    let x_zero = zero(planner, node, inputs, 2, x)?;
    let weights = planner.known(node, w)?;
    let zeros = match zero(planner, node, inputs, 3, w)? {
        Some(zeros) => numbers(&*planner.known(node, zeros)?),
        None => vec![0],
    };
    let (dims, is_signed) = (planner.shape(x), planner.kind(x) == Kind::I8);
    let [outputs, channels, kernel @ ..] = weights.shape.as_slice() else {
        return Err(node.damaged("its weights"));
    };
    let (outputs, channels, rank) = (*outputs, *channels, kernel.len());
    if !(1..=2).contains(&rank) {
        return Err(node.refused(&format!("an input of {} dimensions", dims.len())));
    }
    let groups = usize::try_from(node.int_or("group", 1)).unwrap_or(0);
    let fits = groups > 0
        && dims.len() == rank + 2
        && Some(dims[1]) == channels.checked_mul(groups)
        && outputs % groups == 0
        && [1, outputs].contains(&zeros.len())
        && !weights.shape.contains(&0);
    if !fits {
        return Err(node.damaged(&format!("weights {:?} for an input {dims:?}", weights.shape)));
    }
    let window = window(node, &dims[2..], kernel, false)?;
    let shape = output_shape(&window, dims[0], outputs, rank);
    count(&shape)?;
    let taps = taps(&weights, &zeros, groups);
    let x = planner.channels_last(x)?;
    let (batch, outputs) = (dims[0], outputs / groups);
    let step = SumStep { window, batch, taps: taps.into(), groups, channels, outputs, is_signed };
    planner.emit(step, &[Some(x), x_zero], &[(Kind::I32, shape, Layout::ChannelsLast)])
}

/// Returns the weights without their zero points, in the order group, tap, channel, output.
fn taps(weights: &Constant, zeros: &[i32], groups: usize) -> Vec<i32> {
    let numbers = numbers(weights);
    let [outputs, channels, ..] = weights.shape[..] else { return Vec::new() };
    let pixels: usize = weights.shape[2..].iter().product();
    let per_group = outputs / groups;
    let mut taps = Vec::with_capacity(numbers.len());
    for group in 0..groups {
        for pixel in 0..pixels {
            for channel in 0..channels {
                for output in group * per_group..(group + 1) * per_group {
                    let zero = if zeros.len() == 1 { zeros[0] } else { zeros[output] };
                    taps.push(numbers[(output * channels + channel) * pixels + pixel] - zero);
                }
            }
        }
    }
    taps
}

struct SumStep {
    window: Window,
    batch: usize,
    taps: Arc<[i32]>,
    groups: usize,
    /// Channels and outputs of a group.
    channels: usize,
    outputs: usize,
    is_signed: bool,
}

impl Kernel for SumStep {
    fn run(&self, io: &mut Io<'_>) -> Result<()> {
        let (x, zero, y) = (io.read::<u8>(0), io.read::<u8>(1), io.write::<i32>());
        let zero = zero.first().map_or(0, |&zero| number(zero, self.is_signed));
        let Window { input, output, .. } = self.window;
        let pixel = self.groups * self.outputs;
        let row = output[1] * pixel;
        if y.is_empty() || row == 0 {
            return Ok(());
        }
        let image = input[0] * input[1] * self.groups * self.channels;
        io.compute.pool().run_on_pieces(y, row, |index, y| {
            let x = &x[index / output[0] * image..][..image];
            for (column, y) in y.chunks_mut(pixel).enumerate() {
                self.pixel(x, [index % output[0], column], zero, y);
            }
        });
        Ok(())
    }

    fn cost(&self) -> LayerCost {
        let Window { kernel, output, .. } = self.window;
        let factors = [self.groups, self.outputs, self.channels, kernel[0], kernel[1], output[0], output[1]];
        LayerCost::bytes(&factors) * self.batch
    }
}

impl SumStep {
    /// Computes an output pixel. Pixels outside of the image have the value of the zero point, and add nothing.
    fn pixel(&self, x: &[u8], at: [usize; 2], zero: i32, y: &mut [i32]) {
        let Window { kernel, strides, dilations, pads, input, .. } = self.window;
        y.fill(0);
        let place = |d: usize, tap: usize| {
            let place = (at[d] * strides[d] + tap * dilations[d]).checked_sub(pads[d]);
            place.filter(|&place| place < input[d])
        };
        let per_tap = self.channels * self.outputs;
        let per_group = kernel[0] * kernel[1] * per_tap;
        for tap in 0..kernel[0] * kernel[1] {
            let (Some(row), Some(column)) = (place(0, tap / kernel[1]), place(1, tap % kernel[1])) else {
                continue;
            };
            let pixel = &x[(row * input[1] + column) * self.groups * self.channels..];
            for (group, y) in y.chunks_mut(self.outputs).enumerate() {
                let taps = &self.taps[group * per_group + tap * per_tap..][..per_tap];
                let values = &pixel[group * self.channels..][..self.channels];
                for (taps, &value) in taps.chunks(self.outputs).zip(values) {
                    let value = number(value, self.is_signed) - zero;
                    y.iter_mut().zip(taps).for_each(|(y, tap)| *y = y.wrapping_add(value * tap));
                }
            }
        }
    }
}
