//! Convolutions.

use std::sync::Arc;

use opendr_engine::Result;
use opendr_kernels::{
    Convolution, DepthwiseConvolution, DepthwiseFilters, DepthwisePointwise, Filters, Finish, LayerCost,
    Strides, Window, Winograd, WinogradFilters,
};
use opendr_onnx::proto::NodeProto;

use super::fusion::{self, Fused, Fusible};
use super::inputs::{optional, required};
use crate::attributes::Attributes;
use crate::constant::Constant;
use crate::graph::Packed;
use crate::io::{Io, Kernel};
use crate::planner::{Id, Layout, Planner};
use crate::tensor::{Kind, count};

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
    let weights = planner.known(node, required(node, inputs, 1)?)?;
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
    let fusible = Fusible { axis: 1, bias: bias.is_none(), sum: true };
    if channels == 1 && groups == outputs && groups > 1 {
        let x = planner.channels_last(x)?;
        let fused = fusion::after(planner, node, &shape, Fusible { sum: false, ..fusible });
        let bias = bias.or(fused.bias.as_deref());
        let filters = planner.packed(0, || {
            Packed::Depthwise(Arc::new(DepthwiseFilters::new(floats, outputs, window.kernel, bias)))
        });
        let Packed::Depthwise(filters) = filters else { return Err(node.refused("weights of two kinds")) };
        let finish = finish(&fused, |slopes| filters.padded(slopes));
        let conv = DepthwiseConvolution {
            filters,
            window,
            batch: dims[0],
            x: Strides::channels_last(window.input, outputs),
            y: Strides::channels_last(window.output, outputs),
            finish,
        };
        let y = planner.emit_one(
            DepthwiseStep { conv, first: 0 },
            &[x],
            Kind::F32,
            shape,
            Layout::ChannelsLast,
        )?;
        fused.absorb(planner, y);
        return Ok(vec![y]);
    }
    let planar = groups == 1 && dims[1] <= PLANAR && !planner.is_channels_last(x) && window.kernel != [1, 1];
    let x = if planar { planner.plain(x)? } else { planner.channels_last(x)? };
    let compute = planner.compute.clone();
    let fused = fusion::after(planner, node, &shape, fusible);
    let bias = bias.or(fused.bias.as_deref());
    if groups == 1 && !planar && Winograd::is_faster(&window, [outputs, channels]) {
        let filters = planner.packed(3, || {
            Packed::Winograd(Arc::new(WinogradFilters::new(&compute, floats, [outputs, channels], bias)))
        });
        let Packed::Winograd(filters) = filters else { return Err(node.refused("weights of two kinds")) };
        let finish = finish(&fused, |slopes| filters.padded(slopes));
        let y = Strides::channels_last(window.output, outputs);
        let conv = Winograd { filters, window, batch: dims[0], y, finish };
        return emit_fused(planner, WinogradStep { conv, first: 0 }, x, fused, shape);
    }
    let filters = planner.packed(1 + u8::from(planar), || {
        let sizes = [groups, outputs / groups, channels];
        Packed::Dense(Arc::new(Filters::new(&compute, floats, sizes, window.kernel, bias, planar)))
    });
    let Packed::Dense(filters) = filters else { return Err(node.refused("weights of two kinds")) };
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
    let pair = planner.only_step(x).and_then(|step| {
        let step = &planner.steps[step];
        let pair = DepthwisePointwise::new(step.kernel.depthwise()?, &conv)?;
        Some((pair, step.reads.first().copied().flatten()?))
    });
    match pair {
        // The depthwise convolution has no step of its own then, as nothing reads it.
        Some((pair, x)) => emit_fused(planner, PairStep { pair, first: 0 }, x, fused, shape),
        None => emit_fused(planner, ConvStep::new(conv), x, fused, shape),
    }
}

/// Emits a convolution of an input and what is fused into it.
pub(super) fn emit_fused(
    planner: &mut Planner<'_>,
    kernel: impl Kernel + 'static,
    x: Id,
    fused: Fused,
    shape: Vec<usize>,
) -> Result<Vec<Id>> {
    let residual = match fused.residual {
        Some(residual) => Some(planner.channels_last(residual)?),
        None => None,
    };
    let ids = planner.emit(kernel, &[Some(x), residual], &[(Kind::F32, shape, Layout::ChannelsLast)])?;
    if let Some(&y) = ids.first() {
        fused.absorb(planner, y);
    }
    Ok(ids)
}

/// Returns a bias of floats, if there is one.
pub(super) fn constant_bias(
    planner: &Planner<'_>,
    node: &NodeProto,
    inputs: &[Option<Id>],
    slot: usize,
) -> Result<Option<Arc<Constant>>> {
    let Some(id) = optional(inputs, slot) else { return Ok(None) };
    let bias = planner.known(node, id)?;
    if bias.floats().is_none() {
        return Err(node.refused("a bias that is not of floats"));
    }
    Ok(Some(bias))
}

pub(super) fn finish(fused: &Fused, padded: impl Fn(&[f32]) -> Vec<f32>) -> Finish {
    Finish {
        activation: fused.activation,
        slopes: fused.slopes.as_ref().map(|slopes| padded(slopes).into()),
        residual_last: fused.residual_last,
    }
}

/// A step whose output may lie in some of the channels of wider images.
pub(super) struct ConvStep {
    conv: Convolution,
    first: usize,
}

impl ConvStep {
    pub(super) fn new(conv: Convolution) -> Self {
        Self { conv, first: 0 }
    }
}

impl Kernel for ConvStep {
    fn run(&self, io: &mut Io<'_>) -> Result<()> {
        let x = io.read::<f32>(0);
        let residual = io.has(1).then(|| io.read::<f32>(1));
        self.conv.run(io.compute, x, residual, &mut io.write()[self.first..]);
        Ok(())
    }

    fn cost(&self) -> LayerCost {
        self.conv.cost()
    }

    fn widen(&mut self, channels: usize, first: usize) -> bool {
        let (output, y) = (self.conv.window.output, &mut self.conv.y);
        let is_whole = *y == Strides::channels_last(output, self.conv.filters.outputs());
        if is_whole {
            *y = Strides::channels_last(output, channels);
            self.first = first;
        }
        is_whole
    }
}

struct DepthwiseStep {
    conv: DepthwiseConvolution,
    first: usize,
}

impl Kernel for DepthwiseStep {
    fn run(&self, io: &mut Io<'_>) -> Result<()> {
        let x = io.read::<f32>(0);
        self.conv.run(io.compute, x, &mut io.write()[self.first..]);
        Ok(())
    }

    fn cost(&self) -> LayerCost {
        self.conv.cost()
    }

    fn widen(&mut self, channels: usize, first: usize) -> bool {
        self.conv.y = Strides::channels_last(self.conv.window.output, channels);
        self.first = first;
        true
    }

    fn depthwise(&self) -> Option<&DepthwiseConvolution> {
        Some(&self.conv)
    }
}

struct PairStep {
    pair: DepthwisePointwise,
    first: usize,
}

impl Kernel for PairStep {
    fn run(&self, io: &mut Io<'_>) -> Result<()> {
        let x = io.read::<f32>(0);
        let residual = io.has(1).then(|| io.read::<f32>(1));
        self.pair.run(io.compute, x, residual, &mut io.write()[self.first..]);
        Ok(())
    }

    fn cost(&self) -> LayerCost {
        self.pair.cost()
    }

    fn widen(&mut self, channels: usize, first: usize) -> bool {
        self.pair.widen(channels);
        self.first = first;
        true
    }
}

struct WinogradStep {
    conv: Winograd,
    first: usize,
}

impl Kernel for WinogradStep {
    fn run(&self, io: &mut Io<'_>) -> Result<()> {
        let x = io.read::<f32>(0);
        let residual = io.has(1).then(|| io.read::<f32>(1));
        self.conv.run(io.compute, x, residual, &mut io.write()[self.first..]);
        Ok(())
    }

    fn cost(&self) -> LayerCost {
        self.conv.cost()
    }

    fn widen(&mut self, channels: usize, first: usize) -> bool {
        self.conv.y = Strides::channels_last(self.conv.window.output, channels);
        self.first = first;
        true
    }
}
