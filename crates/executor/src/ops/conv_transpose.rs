//! Transposed convolutions.
//!
//! The output pixels whose distance is a multiple of the stride are a phase: each depends on the same taps of the kernel, so a phase is
//! a convolution of the input whose output pixels lie apart. Where a phase has no taps, or a group has so few outputs that registers would
//! stay empty, the products of all pixels and weights are computed first and added where they overlap.

use std::sync::Arc;

use opendr_engine::Result;
use opendr_kernels::{
    Convolution, Filters, Finish, LayerCost, Phase, Strides, Window, phases, window_of_phase,
};
use opendr_onnx::proto::NodeProto;

use super::conv::{ConvStep, constant_bias, emit_fused, finish};
use super::fusion::{self, Fusible};
use super::inputs::required;
use crate::attributes::Attributes;
use crate::constant::Constant;
use crate::graph::Packed;
use crate::io::{Io, Kernel};
use crate::planner::{Id, Layout, Planner};
use crate::tensor::{Kind, count};

/// Outputs of a group below which the phases would leave most of a register empty.
const MIN_OUTPUTS: usize = 8;
/// Number of phases up to which each has filters of its own.
const MAX_PHASES: usize = 64;
/// Numbers of the products of pixels and weights beyond which a node is refused.
const MAX_PRODUCTS: usize = 1 << 27;

/// Sizes of a transposed convolution; one of one dimension has a height of 1.
#[derive(Debug, Clone)]
struct Geometry {
    batch: usize,
    groups: usize,
    /// Channels of the input and of the output per group.
    inputs: usize,
    outputs: usize,
    input: [usize; 2],
    output: [usize; 2],
    kernel: [usize; 2],
    strides: [usize; 2],
    dilations: [usize; 2],
    pads: [usize; 2],
}

pub(crate) fn build(planner: &mut Planner<'_>, node: &NodeProto, inputs: &[Option<Id>]) -> Result<Vec<Id>> {
    let x = required(node, inputs, 0)?;
    let dims = planner.shape(x);
    let weights = planner.known(node, required(node, inputs, 1)?)?;
    let bias = constant_bias(planner, node, inputs, 2)?;
    let floats = weights.floats().ok_or_else(|| node.refused("weights that are not floats"))?;
    if planner.kind(x) != Kind::F32 {
        return Err(node.refused(&format!("an input of {:?}", planner.kind(x))));
    }
    let geometry = geometry(node, &dims, &weights)?;
    let outputs = geometry.outputs * geometry.groups;
    if bias.as_ref().is_some_and(|bias| bias.shape != [outputs]) {
        return Err(node.damaged("its bias"));
    }
    let bias = bias.as_ref().and_then(|bias| bias.floats());
    let mut shape = vec![geometry.batch, outputs];
    shape.extend(&geometry.output[4 - dims.len()..]);
    count(&shape)?;
    let phases = [geometry.phases(0), geometry.phases(1)];
    let is_empty = |phases: &[Phase]| phases.iter().any(|phase| phase.taps.is_empty());
    if geometry.outputs < MIN_OUTPUTS
        || phases.iter().any(|phases| is_empty(phases))
        || phases[0].len() * phases[1].len() > MAX_PHASES
    {
        Ok(vec![by_products(planner, node, x, &geometry, floats, bias, shape)?])
    } else {
        by_phases(planner, node, x, &geometry, &phases, floats, bias, shape)
    }
}

fn geometry(node: &NodeProto, dims: &[usize], weights: &Constant) -> Result<Geometry> {
    let ([batch, channels, spatial @ ..], [weight_inputs, outputs, kernel @ ..]) =
        (dims, weights.shape.as_slice())
    else {
        return Err(node.damaged("its input or weights"));
    };
    let rank = spatial.len();
    if !(1..=2).contains(&rank) {
        return Err(node.refused(&format!("an input of {} dimensions", dims.len())));
    }
    let groups = usize::try_from(node.int_or("group", 1)).unwrap_or(0);
    if groups == 0
        || weight_inputs != channels
        || channels % groups != 0
        || kernel.len() != rank
        || kernel.contains(&0)
    {
        return Err(node.damaged(&format!("weights {:?} for an input {dims:?}", weights.shape)));
    }
    let (strides, dilations) = (node.sizes("strides", rank, 1)?, node.sizes("dilations", rank, 1)?);
    let (mut pads, extra) = (node.sizes("pads", 2 * rank, 0)?, node.sizes("output_padding", rank, 0)?);
    if strides.contains(&0) || dilations.contains(&0) {
        return Err(node.damaged("a stride or dilation of 0"));
    }
    let auto_pad = node.text("auto_pad", "NOTSET");
    let stated = match node.find("output_shape") {
        Some(_) => Some(node.sizes("output_shape", rank, 0)?),
        None => None,
    };
    let mut output = vec![0; rank];
    for i in 0..rank {
        // The size without padding.
        let whole = || -> Option<usize> {
            let span = (kernel[i] - 1).checked_mul(dilations[i])?.checked_add(1)?;
            spatial[i].checked_sub(1)?.checked_mul(strides[i])?.checked_add(span)?.checked_add(extra[i])
        };
        let whole = whole().ok_or_else(|| node.damaged("its sizes"))?;
        let is_same = auto_pad.starts_with("SAME");
        let wanted = stated.as_ref().map(|sizes| sizes[i]).or(if is_same {
            spatial[i].checked_mul(strides[i])
        } else {
            None
        });
        if let Some(wanted) = wanted {
            // A smaller kernel than its stride leaves nothing to cut off.
            let total = whole.saturating_sub(wanted);
            let less = total / 2;
            (pads[i], pads[rank + i]) =
                if auto_pad == "SAME_UPPER" { (less, total - less) } else { (total - less, less) };
            output[i] = wanted;
        } else {
            if auto_pad == "VALID" {
                (pads[i], pads[rank + i]) = (0, 0);
            }
            let cut = pads[i].checked_add(pads[rank + i]);
            output[i] =
                cut.and_then(|cut| whole.checked_sub(cut)).ok_or_else(|| node.damaged("its padding"))?;
        }
    }
    let two = |values: &[usize], filler: usize| match values {
        [first, second, ..] => [*first, *second],
        [one] => [filler, *one],
        [] => [filler; 2],
    };
    Ok(Geometry {
        batch: *batch,
        groups,
        inputs: channels / groups,
        outputs: *outputs,
        input: two(spatial, 1),
        output: two(&output, 1),
        kernel: two(kernel, 1),
        strides: two(&strides, 1),
        dilations: two(&dilations, 1),
        pads: two(&pads[..rank], 0),
    })
}

impl Geometry {
    /// Returns the phases along an axis that have pixels.
    fn phases(&self, axis: usize) -> Vec<Phase> {
        phases(
            self.kernel[axis],
            self.strides[axis],
            self.dilations[axis],
            self.pads[axis],
            self.output[axis],
        )
    }
}

#[expect(clippy::too_many_arguments, reason = "the parts of one node")]
fn by_phases(
    planner: &mut Planner<'_>,
    node: &NodeProto,
    x: Id,
    geometry: &Geometry,
    [rows, columns]: &[Vec<Phase>; 2],
    floats: &[f32],
    bias: Option<&[f32]>,
    shape: Vec<usize>,
) -> Result<Vec<Id>> {
    let Geometry { batch, groups, inputs, outputs, .. } = *geometry;
    let (in_channels, out_channels) = (groups * inputs, groups * outputs);
    let whole_x = Strides::channels_last(geometry.input, in_channels);
    let whole_y = Strides::channels_last(geometry.output, out_channels);
    let y = Strides {
        row: geometry.strides[0] * whole_y.row,
        pixel: geometry.strides[1] * whole_y.pixel,
        ..whole_y
    };
    let x = planner.channels_last(x)?;
    let fusible = Fusible { axis: 1, bias: bias.is_none(), sum: true };
    let fused = fusion::after(planner, node, &shape, fusible);
    let bias = bias.or(fused.bias.as_deref());
    let compute = planner.compute.clone();
    let mut phases = Vec::new();
    for (i, row) in rows.iter().enumerate() {
        for (j, column) in columns.iter().enumerate() {
            let (window, begin) = window_of_phase([row, column], geometry.input);
            // At most `MAX_PHASES`.
            let slot = (i * columns.len() + j) as u8;
            let filters = planner.packed(slot, || {
                let weights = sub_kernel(geometry, floats, row, column);
                let sizes = [groups, outputs, inputs];
                Packed::Dense(Arc::new(Filters::new(&compute, &weights, sizes, window.kernel, bias, false)))
            });
            let Packed::Dense(filters) = filters else { return Err(node.refused("weights of two kinds")) };
            let finish = finish(&fused, |slopes| filters.padded(slopes));
            phases.push(PhaseStep {
                conv: Convolution { filters, window, batch, x: whole_x, y, residual: y, finish },
                from: begin[0] * whole_x.row + begin[1] * whole_x.pixel,
                to: i * whole_y.row + j * whole_y.pixel,
            });
        }
    }
    emit_fused(planner, PhasesStep(phases), x, fused, shape)
}

/// Returns the weights of a phase, `[groups * outputs, inputs, rows, columns]`.
fn sub_kernel(geometry: &Geometry, floats: &[f32], rows: &Phase, columns: &Phase) -> Vec<f32> {
    let Geometry { groups, inputs, outputs, kernel, .. } = *geometry;
    let mut weights = Vec::with_capacity(groups * outputs * inputs * rows.taps.len() * columns.taps.len());
    for group in 0..groups {
        for output in 0..outputs {
            for input in 0..inputs {
                let from = ((group * inputs + input) * outputs + output) * kernel[0] * kernel[1];
                for row in &rows.taps {
                    weights.extend(columns.taps.iter().map(|column| floats[from + row * kernel[1] + column]));
                }
            }
        }
    }
    weights
}

struct PhaseStep {
    conv: Convolution,
    /// First number of the input and of the output.
    from: usize,
    to: usize,
}

struct PhasesStep(Vec<PhaseStep>);

impl Kernel for PhasesStep {
    fn run(&self, io: &mut Io<'_>) -> Result<()> {
        let x = io.read::<f32>(0);
        let residual = io.has(1).then(|| io.read::<f32>(1));
        let y = io.write::<f32>();
        for phase in &self.0 {
            let x = x.get(phase.from..).unwrap_or_default();
            let residual = residual.and_then(|residual| residual.get(phase.to..));
            phase.conv.run(io.compute, x, residual, y.get_mut(phase.to..).unwrap_or_default());
        }
        Ok(())
    }

    fn cost(&self) -> LayerCost {
        self.0.iter().fold(LayerCost::default(), |sum, phase| sum + phase.conv.cost())
    }
}

/// Each input pixel adds a kernel of outputs: a product of pixels and weights, then the sum where they overlap.
fn by_products(
    planner: &mut Planner<'_>,
    node: &NodeProto,
    x: Id,
    geometry: &Geometry,
    floats: &[f32],
    bias: Option<&[f32]>,
    shape: Vec<usize>,
) -> Result<Id> {
    let Geometry { batch, groups, inputs, outputs, input, kernel, .. } = *geometry;
    let taps = kernel[0] * kernel[1];
    let columns = outputs * taps;
    if count(&[batch, input[0], input[1], groups, columns])? > MAX_PRODUCTS {
        return Err(node.refused("its size"));
    }
    let x = planner.channels_last(x)?;
    let compute = planner.compute.clone();
    let filters = planner.packed(u8::MAX, || {
        // From [input, output, tap] to [group, tap, output, input].
        let mut packed = vec![0.0; floats.len()];
        for channel in 0..groups * inputs {
            let (group, inner) = (channel / inputs, channel % inputs);
            for output in 0..outputs {
                for tap in 0..taps {
                    packed[(group * columns + tap * outputs + output) * inputs + inner] =
                        floats[(channel * outputs + output) * taps + tap];
                }
            }
        }
        let sizes = [groups, columns, inputs];
        Packed::Dense(Arc::new(Filters::new(&compute, &packed, sizes, [1, 1], None, false)))
    });
    let Packed::Dense(filters) = filters else { return Err(node.refused("weights of two kinds")) };
    let window =
        Window { kernel: [1, 1], strides: [1, 1], dilations: [1, 1], pads: [0, 0], input, output: input };
    let y = Strides::channels_last(input, groups * columns);
    let conv = Convolution {
        filters,
        window,
        batch,
        x: Strides::channels_last(input, groups * inputs),
        y,
        residual: y,
        finish: Finish::default(),
    };
    let products = planner.emit_one(
        ConvStep::new(conv),
        &[x],
        Kind::F32,
        vec![batch, groups * columns, input[0], input[1]],
        Layout::ChannelsLast,
    )?;
    let bias = bias.map_or_else(|| vec![0.0; groups * outputs], <[f32]>::to_vec);
    let step = ScatterStep { geometry: geometry.clone(), bias };
    planner.emit_one(step, &[products], Kind::F32, shape, Layout::ChannelsLast)
}

/// Adds the products of each input pixel where its kernel lies in the output.
struct ScatterStep {
    geometry: Geometry,
    bias: Vec<f32>,
}

impl Kernel for ScatterStep {
    fn run(&self, io: &mut Io<'_>) -> Result<()> {
        let (x, y) = (io.read::<f32>(0), io.write::<f32>());
        let Geometry { groups, outputs, input, output, kernel, strides, dilations, pads, .. } = self.geometry;
        let channels = groups * outputs;
        let [height, width] = input;
        let columns = kernel[0] * kernel[1] * outputs;
        let row = output[1] * channels;
        if y.is_empty() {
            return Ok(());
        }
        io.compute.pool().run_on_pieces(y, row, |index, y| {
            let (image, oy) = (index / output[0], index % output[0]);
            y.chunks_mut(channels).for_each(|y| y.copy_from_slice(&self.bias));
            for ky in 0..kernel[0] {
                let at = (oy + pads[0]).checked_sub(ky * dilations[0]);
                let Some(iy) = at.filter(|at| at % strides[0] == 0).map(|at| at / strides[0]) else {
                    continue;
                };
                if iy >= height {
                    continue;
                }
                for ix in 0..width {
                    let pixel = &x[((image * height + iy) * width + ix) * groups * columns..];
                    for kx in 0..kernel[1] {
                        let at = (ix * strides[1] + kx * dilations[1]).checked_sub(pads[1]);
                        let Some(ox) = at.filter(|&at| at < output[1]) else { continue };
                        for group in 0..groups {
                            let from = group * columns + (ky * kernel[1] + kx) * outputs;
                            let y = &mut y[ox * channels + group * outputs..][..outputs];
                            y.iter_mut().zip(&pixel[from..from + outputs]).for_each(|(y, x)| *y += x);
                        }
                    }
                }
            }
        });
        Ok(())
    }
}
