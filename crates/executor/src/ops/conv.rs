//! Convolutions.

use std::sync::Arc;

use opendr_engine::Result;
use opendr_kernels::{Convolution, DepthwiseConvolution, DepthwiseFilters, Filters, Finish, Strides, Window};
use opendr_onnx::proto::NodeProto;

use super::fusion::{self, Fused};
use super::inputs::{optional, required};
use crate::attributes::Attributes;
use crate::graph::Packed;
use crate::io::{Io, Kernel};
use crate::planner::{Id, Layout, Planner};
use crate::tensor::{Constant, Kind, count};

/// Channels of a planar input up to which it is read as it is.
const PLANAR: usize = 4;

/// Geometry of a convolution or pooling in two dimensions; one of one dimension has a height of 1.
pub(crate) fn window(node: &NodeProto, dims: &[usize], kernel: &[usize], is_ceil: bool) -> Result<Window> {
    let rank = kernel.len();
    let strides = node.sizes("strides", rank, 1)?;
    let dilations = node.sizes("dilations", rank, 1)?;
    let mut pads = node.sizes("pads", 2 * rank, 0)?;
    if strides.contains(&0) || dilations.contains(&0) || kernel.contains(&0) {
        return Err(node.damaged("a kernel, stride or dilation of 0"));
    }
    let mut output = vec![0; rank];
    for i in 0..rank {
        let span = (kernel[i] - 1).checked_mul(dilations[i]).and_then(|span| span.checked_add(1));
        let span = span.ok_or_else(|| node.damaged("the kernel is too large"))?;
        match node.text("auto_pad", "NOTSET").as_str() {
            "SAME_UPPER" | "SAME_LOWER" => {
                let size = dims[i].div_ceil(strides[i]);
                let total = (size.saturating_sub(1) * strides[i] + span).saturating_sub(dims[i]);
                let less = total / 2;
                let upper = node.text("auto_pad", "") == "SAME_UPPER";
                (pads[i], pads[rank + i]) = if upper { (less, total - less) } else { (total - less, less) };
            }
            "VALID" => (pads[i], pads[rank + i]) = (0, 0),
            _ => {}
        }
        let padded = dims[i] + pads[i] + pads[rank + i];
        let rest = padded
            .checked_sub(span)
            .ok_or_else(|| node.damaged(&format!("the input {dims:?} is smaller than the kernel")))?;
        output[i] = rest / strides[i] + 1;
        if is_ceil && rest % strides[i] != 0 && output[i] * strides[i] < dims[i] + pads[i] {
            output[i] += 1;
        }
    }
    let two = |values: &[usize], filler: usize| match values {
        [one] => [filler, *one],
        [first, second, ..] => [*first, *second],
        [] => [filler; 2],
    };
    Ok(Window {
        kernel: two(kernel, 1),
        strides: two(&strides, 1),
        dilations: two(&dilations, 1),
        pads: two(&pads[..rank], 0),
        input: two(dims, 1),
        output: two(&output, 1),
    })
}

/// Returns the shape of an output with that many channels.
pub(crate) fn output_shape(window: &Window, batch: usize, channels: usize, rank: usize) -> Vec<usize> {
    let mut shape = vec![batch, channels];
    shape.extend(&window.output[2 - rank..]);
    shape
}

pub(crate) fn conv(planner: &mut Planner<'_>, node: &NodeProto, inputs: &[Option<Id>]) -> Result<Vec<Id>> {
    let x = required(node, inputs, 0)?;
    let dims = planner.shape(x);
    let weights = planner
        .constant(required(node, inputs, 1)?)
        .ok_or_else(|| node.refused("weights that are not constant"))?;
    let bias = constant_bias(planner, node, inputs, 2)?;
    if planner.kind(x) != Kind::F32 || !(3..=4).contains(&dims.len()) {
        return Err(node.refused(&format!(
            "an input of {:?} with {} dimensions",
            planner.kind(x),
            dims.len()
        )));
    }
    let floats = weights.floats().ok_or_else(|| node.refused("weights that are not floats"))?;
    let [outputs, channels, kernel @ ..] = weights.shape.as_slice() else {
        return Err(node.damaged("its weights"));
    };
    let (outputs, channels, rank) = (*outputs, *channels, dims.len() - 2);
    let groups = usize::try_from(node.int_or("group", 1)).unwrap_or(0);
    let fits = groups > 0
        && kernel.len() == rank
        && Some(dims[1]) == channels.checked_mul(groups)
        && outputs % groups == 0
        && bias.as_ref().is_none_or(|bias| bias.shape == [outputs]);
    if !fits || floats.is_empty() {
        return Err(node.damaged(&format!("weights {:?} for an input {dims:?}", weights.shape)));
    }
    let window = window(node, &dims[2..], kernel, false)?;
    let shape = output_shape(&window, dims[0], outputs, rank);
    count(&shape)?;
    let bias = bias.as_ref().and_then(|bias| bias.floats());
    let index = planner.node;
    if channels == 1 && groups == outputs && groups > 1 {
        let x = planner.channels_last(x)?;
        let filters = planner.graph.packed((index, 0), || {
            Packed::Depthwise(Arc::new(DepthwiseFilters::new(floats, outputs, window.kernel, bias)))
        });
        let Packed::Depthwise(filters) = filters else { return Err(node.refused("weights of two kinds")) };
        let fused = fusion::after(planner, node, &shape, false);
        let finish = finish(&fused, |slopes| filters.padded(slopes));
        let step = DepthwiseStep(DepthwiseConvolution {
            filters,
            window,
            batch: dims[0],
            x: Strides::channels_last(window.input, outputs),
            y: Strides::channels_last(window.output, outputs),
            finish,
        });
        let y = planner.emit_one(step, &[x], Kind::F32, shape, Layout::ChannelsLast)?;
        fused.absorb(planner, y);
        return Ok(vec![y]);
    }
    let planar = groups == 1 && dims[1] <= PLANAR && !planner.is_channels_last(x) && window.kernel != [1, 1];
    let x = if planar { planner.plain(x)? } else { planner.channels_last(x)? };
    let compute = planner.compute.clone();
    let filters = planner.graph.packed((index, 1 + u8::from(planar)), || {
        let sizes = [groups, outputs / groups, channels];
        Packed::Dense(Arc::new(Filters::new(&compute, floats, sizes, window.kernel, bias, planar)))
    });
    let Packed::Dense(filters) = filters else { return Err(node.refused("weights of two kinds")) };
    let fused = fusion::after(planner, node, &shape, true);
    let finish = finish(&fused, |slopes| filters.padded(slopes));
    let y = Strides::channels_last(window.output, outputs);
    let conv = Convolution {
        filters,
        window,
        batch: dims[0],
        x: if planar {
            Strides::planar(window.input, dims[1])
        } else {
            Strides::channels_last(window.input, dims[1])
        },
        y,
        residual: y,
        finish,
    };
    let residual = match fused.residual {
        Some(residual) => Some(planner.channels_last(residual)?),
        None => None,
    };
    let ids =
        planner.emit(ConvStep(conv), &[Some(x), residual], &[(Kind::F32, shape, Layout::ChannelsLast)])?;
    if let Some(&y) = ids.first() {
        fused.absorb(planner, y);
    }
    Ok(ids)
}

/// Returns a bias of floats, if there is one.
fn constant_bias(
    planner: &Planner<'_>,
    node: &NodeProto,
    inputs: &[Option<Id>],
    slot: usize,
) -> Result<Option<Arc<Constant>>> {
    let Some(id) = optional(inputs, slot) else { return Ok(None) };
    let bias = planner.constant(id).filter(|bias| bias.floats().is_some());
    bias.map(Some).ok_or_else(|| node.refused("a bias that is not a constant of floats"))
}

fn finish(fused: &Fused, padded: impl Fn(&[f32]) -> Vec<f32>) -> Finish {
    Finish {
        activation: fused.activation,
        slopes: fused.slopes.as_ref().map(|slopes| padded(slopes).into()),
        residual_last: fused.residual_last,
    }
}

struct ConvStep(Convolution);

impl Kernel for ConvStep {
    fn run(&self, io: &mut Io<'_>) -> Result<()> {
        let x = io.read::<f32>(0);
        let residual = io.has(1).then(|| io.read::<f32>(1));
        self.0.run(io.compute, x, residual, io.write());
        Ok(())
    }
}

struct DepthwiseStep(DepthwiseConvolution);

impl Kernel for DepthwiseStep {
    fn run(&self, io: &mut Io<'_>) -> Result<()> {
        let x = io.read::<f32>(0);
        self.0.run(io.compute, x, io.write());
        Ok(())
    }
}

/// A transposed convolution becomes a convolution with as many outputs as a block has pixels, and their arrangement.
pub(crate) fn transposed(
    planner: &mut Planner<'_>,
    node: &NodeProto,
    inputs: &[Option<Id>],
) -> Result<Vec<Id>> {
    let x = required(node, inputs, 0)?;
    let dims = planner.shape(x);
    let weights = planner
        .constant(required(node, inputs, 1)?)
        .ok_or_else(|| node.refused("weights that are not constant"))?;
    let bias = constant_bias(planner, node, inputs, 2)?;
    let floats = weights.floats().ok_or_else(|| node.refused("weights that are not floats"))?;
    let [batch, channels, height, width] = dims[..] else {
        return Err(node.refused("an input without two spatial dimensions"));
    };
    let [inputs_of_weights, outputs, kernel_height, kernel_width] = weights.shape[..] else {
        return Err(node.damaged("its weights"));
    };
    let groups = usize::try_from(node.int_or("group", 1)).unwrap_or(0);
    if groups == 0
        || inputs_of_weights != channels
        || channels % groups != 0
        || node.find("output_shape").is_some()
    {
        return Err(node.refused("its groups or its output shape"));
    }
    if node.text("auto_pad", "NOTSET") != "NOTSET" {
        return Err(node.refused("automatic padding"));
    }
    let (strides, dilations) = (node.sizes("strides", 2, 1)?, node.sizes("dilations", 2, 1)?);
    let (pads, extra) = (node.sizes("pads", 4, 0)?, node.sizes("output_padding", 2, 0)?);
    let size = |i: usize, input: usize, kernel: usize| -> Option<usize> {
        let span = input
            .checked_sub(1)?
            .checked_mul(strides[i])?
            .checked_add(kernel.checked_sub(1)?.checked_mul(dilations[i])? + 1)?;
        span.checked_add(extra[i])?.checked_sub(pads[i] + pads[2 + i])
    };
    let sizes = [size(0, height, kernel_height), size(1, width, kernel_width)];
    let [Some(out_height), Some(out_width)] = sizes else { return Err(node.damaged("its padding")) };
    if strides.contains(&0) || planner.kind(x) != Kind::F32 {
        return Err(node.damaged("a stride of 0"));
    }
    let all_outputs = outputs * groups;
    let shape = vec![batch, all_outputs, out_height, out_width];
    count(&shape)?;
    let bias = match bias.as_ref().and_then(|bias| bias.floats()) {
        Some(bias) if bias.len() == all_outputs => bias.to_vec(),
        Some(_) => return Err(node.damaged("its bias")),
        None => vec![0.0; all_outputs],
    };
    // Each input pixel adds a kernel of outputs: a product of pixels and weights, then the sum where they overlap.
    let taps = kernel_height * kernel_width;
    let (group_inputs, columns) = (channels / groups, outputs * taps);
    if count(&[batch, height, width, groups, columns])? > 1 << 27 {
        return Err(node.refused("its size"));
    }
    // From [input, output, tap] to [group, tap, output, input].
    let mut packed = vec![0.0; floats.len()];
    for input in 0..channels {
        let (group, inner) = (input / group_inputs, input % group_inputs);
        for output in 0..outputs {
            for tap in 0..taps {
                packed[(group * columns + tap * outputs + output) * group_inputs + inner] =
                    floats[(input * outputs + output) * taps + tap];
            }
        }
    }
    let x = planner.channels_last(x)?;
    let filters =
        Filters::new(planner.compute, &packed, [groups, columns, group_inputs], [1, 1], None, false);
    let input = [height, width];
    let window =
        Window { kernel: [1, 1], strides: [1, 1], dilations: [1, 1], pads: [0, 0], input, output: input };
    let y = Strides::channels_last(input, groups * columns);
    let conv = Convolution {
        filters: Arc::new(filters),
        window,
        batch,
        x: Strides::channels_last(input, channels),
        y,
        residual: y,
        finish: Finish::default(),
    };
    let products = planner.emit_one(
        ConvStep(conv),
        &[x],
        Kind::F32,
        vec![batch, groups * columns, height, width],
        Layout::ChannelsLast,
    )?;
    let step = ScatterStep {
        batch,
        input,
        output: [out_height, out_width],
        kernel: [kernel_height, kernel_width],
        strides: [strides[0], strides[1]],
        dilations: [dilations[0], dilations[1]],
        pads: [pads[0], pads[1]],
        groups,
        outputs,
        bias,
    };
    Ok(vec![planner.emit_one(step, &[products], Kind::F32, shape, Layout::ChannelsLast)?])
}

/// Adds the products of each input pixel where its kernel lies in the output.
struct ScatterStep {
    batch: usize,
    input: [usize; 2],
    output: [usize; 2],
    kernel: [usize; 2],
    strides: [usize; 2],
    dilations: [usize; 2],
    pads: [usize; 2],
    groups: usize,
    outputs: usize,
    bias: Vec<f32>,
}

impl Kernel for ScatterStep {
    fn run(&self, io: &mut Io<'_>) -> Result<()> {
        let (x, y) = (io.read::<f32>(0), io.write::<f32>());
        let channels = self.groups * self.outputs;
        let [height, width] = self.input;
        let columns = self.kernel[0] * self.kernel[1] * self.outputs;
        let row = self.output[1] * channels;
        if y.is_empty() {
            return Ok(());
        }
        debug_assert_eq!(y.len(), self.batch * self.output[0] * row);
        io.compute.pool().run_on_pieces(y, row, |index, y| {
            let (image, oy) = (index / self.output[0], index % self.output[0]);
            y.chunks_mut(channels).for_each(|y| y.copy_from_slice(&self.bias));
            for ky in 0..self.kernel[0] {
                let at = (oy + self.pads[0]).checked_sub(ky * self.dilations[0]);
                let Some(iy) = at.filter(|at| at % self.strides[0] == 0).map(|at| at / self.strides[0])
                else {
                    continue;
                };
                if iy >= height {
                    continue;
                }
                for ix in 0..width {
                    let pixel = &x[((image * height + iy) * width + ix) * self.groups * columns..];
                    for kx in 0..self.kernel[1] {
                        let at = (ix * self.strides[1] + kx * self.dilations[1]).checked_sub(self.pads[1]);
                        let Some(ox) = at.filter(|&at| at < self.output[1]) else { continue };
                        for group in 0..self.groups {
                            let from = group * columns + (ky * self.kernel[1] + kx) * self.outputs;
                            let y = &mut y[ox * channels + group * self.outputs..][..self.outputs];
                            add(&pixel[from..from + self.outputs], y);
                        }
                    }
                }
            }
        });
        Ok(())
    }
}

fn add(x: &[f32], y: &mut [f32]) {
    y.iter_mut().zip(x).for_each(|(y, x)| *y += x);
}
