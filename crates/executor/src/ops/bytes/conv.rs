//! Convolutions of bytes.

use std::sync::Arc;

use opendr_engine::Result;
use opendr_kernels::{
    ByteConvolution, ByteDepthwise, ByteDepthwiseFilters, ByteFilters, ByteWeights, ByteZero, LayerCost,
};
use opendr_onnx::proto::NodeProto;

use super::super::conv::{output_shape, window};
use super::pattern::{Requantised, dequantised, integers, requantised};
use crate::attributes::Attributes;
use crate::constant::Constant;
use crate::graph::Packed;
use crate::io::{Io, Kernel};
use crate::planner::{Id, Layout, Planner};
use crate::tensor::{Kind, count};

/// Maximum difference of the scale of the bias from the product of the other scales, relative to it.
const BIAS_SCALE: f32 = 1e-4;

pub(crate) fn build(planner: &mut Planner<'_>, node: &NodeProto) -> Result<Option<Vec<Id>>> {
    let Some(x) = node.input.first().and_then(|name| dequantised(planner, name)) else { return Ok(None) };
    let Some(weights) = node.input.get(1).and_then(|name| Weights::read(planner, name)) else {
        return Ok(None);
    };
    let Some(after) = requantised(planner, node) else { return Ok(None) };
    let products: Vec<f32> = weights.scales.iter().map(|scale| x.scale * scale).collect();
    let bias = match node.input.get(2).filter(|name| !name.is_empty()) {
        Some(name) => match bias(planner, name, &products) {
            Some(bias) => bias,
            None => return Ok(None),
        },
        None => Vec::new(),
    };
    let scales: Vec<f32> = products.iter().map(|product| product / after.scale).collect();
    let dims = planner.shape(x.bytes);
    let [outputs, channels, kernel @ ..] = weights.constant.shape.as_slice() else { return Ok(None) };
    let (outputs, channels, rank) = (*outputs, *channels, kernel.len());
    let groups = usize::try_from(node.int_or("group", 1)).unwrap_or(0);
    let is_depthwise = groups > 1 && groups == outputs && channels == 1;
    let fits = (groups == 1 || is_depthwise)
        && (1..=2).contains(&rank)
        && dims.len() == rank + 2
        && Some(dims[1]) == channels.checked_mul(groups)
        && !weights.constant.shape.contains(&0)
        && (bias.is_empty() || bias.len() == outputs)
        && (weights.scales.len() == 1 || weights.scales.len() == outputs)
        && (weights.zeros.len() == 1 || weights.zeros.len() == outputs)
        && scales.iter().all(|scale| scale.is_finite());
    if !fits {
        return Ok(None);
    }
    let window = window(node, &dims[2..], kernel, false)?;
    let shape = output_shape(&window, dims[0], outputs, rank);
    count(&shape)?;
    let compute = planner.compute.clone();
    let make = || {
        let weights = ByteWeights {
            bytes: weights.constant.data.get(weights.constant.region()),
            is_signed: weights.constant.kind == Kind::I8,
            zeros: &weights.zeros,
            outputs,
            channels,
            kernel: window.kernel,
            bias: &bias,
            scales: &scales,
        };
        packed(&compute, &weights, x.zero, is_depthwise)
    };
    let filters = planner.packed(8, make);
    let (batch, output) = (dims[0], after.output);
    let x = planner.channels_last(x.bytes)?;
    let y = match filters {
        Packed::Bytes(filters) => {
            let step = ConvStep(ByteConvolution { filters, window, batch, output });
            planner.emit_one(step, &[x], after.kind(), shape, Layout::ChannelsLast)?
        }
        Packed::ByteDepthwise(filters) => {
            let step = DepthwiseStep(ByteDepthwise { filters, window, batch, output });
            planner.emit_one(step, &[x], after.kind(), shape, Layout::ChannelsLast)?
        }
        _ => return Err(node.refused("weights of two kinds")),
    };
    finished(planner, &after, y)
}

fn packed(
    compute: &opendr_kernels::Compute,
    weights: &ByteWeights<'_>,
    input: ByteZero,
    is_depthwise: bool,
) -> Packed {
    if is_depthwise {
        Packed::ByteDepthwise(Arc::new(ByteDepthwiseFilters::new(compute, weights, input)))
    } else {
        Packed::Bytes(Arc::new(ByteFilters::new(compute, weights, input)))
    }
}

fn finished(planner: &mut Planner<'_>, after: &Requantised, y: Id) -> Result<Option<Vec<Id>>> {
    after.absorb(planner, y);
    Ok(Some(vec![y]))
}

/// Constant weights of bytes, with scales and zero points.
struct Weights {
    constant: Arc<Constant>,
    scales: Vec<f32>,
    zeros: Vec<i32>,
}

impl Weights {
    fn read(planner: &Planner<'_>, name: &str) -> Option<Self> {
        let node = planner.deferred(name)?;
        let constant = planner.constant(planner.named(node.input.first()?)?)?;
        if !matches!(constant.kind, Kind::U8 | Kind::I8) || node.int_or("block_size", 0) != 0 {
            return None;
        }
        let scale = planner.constant(planner.named(node.input.get(1)?)?)?;
        let scales = scale.floats()?.to_vec();
        let zeros = match node.input.get(2).filter(|name| !name.is_empty()) {
            Some(name) => {
                let zeros = planner.constant(planner.named(name)?)?;
                if zeros.kind != constant.kind || zeros.shape != scale.shape {
                    return None;
                }
                integers(&zeros)?
            }
            None => vec![0],
        };
        let per_output = scales.len() == 1 || node.int_or("axis", 1) == 0;
        let is_plain = per_output && !zeros.is_empty() && scales.iter().all(|&scale| scale.is_finite());
        is_plain.then_some(Self { constant, scales, zeros })
    }
}

/// Returns a bias in units of the sums; `None` where it has another scale.
fn bias(planner: &Planner<'_>, name: &str, products: &[f32]) -> Option<Vec<i32>> {
    let node = planner.deferred(name)?;
    let bias = planner.constant(planner.named(node.input.first()?)?)?;
    let scale = planner.constant(planner.named(node.input.get(1)?)?)?;
    let scales = scale.floats()?;
    let zeros = match node.input.get(2).filter(|name| !name.is_empty()) {
        Some(name) => integers(&*planner.constant(planner.named(name)?)?)?,
        None => Vec::new(),
    };
    let is_near = |(i, scale): (usize, &f32)| {
        let product = if products.len() == 1 { products.first() } else { products.get(i) };
        product.is_some_and(|product| (scale - product).abs() <= BIAS_SCALE * product.abs())
    };
    let fits = bias.kind == Kind::I32
        && zeros.iter().all(|&zero| zero == 0)
        && (scales.len() == products.len() || products.len() == 1)
        && scales.iter().enumerate().all(is_near);
    fits.then(|| integers(&bias)).flatten()
}

struct ConvStep(ByteConvolution);

impl Kernel for ConvStep {
    fn run(&self, io: &mut Io<'_>) -> Result<()> {
        let x = io.read::<u8>(0);
        self.0.run(io.compute, x, io.write());
        Ok(())
    }

    fn cost(&self) -> LayerCost {
        self.0.cost()
    }
}

struct DepthwiseStep(ByteDepthwise);

impl Kernel for DepthwiseStep {
    fn run(&self, io: &mut Io<'_>) -> Result<()> {
        let x = io.read::<u8>(0);
        self.0.run(io.compute, x, io.write());
        Ok(())
    }

    fn cost(&self) -> LayerCost {
        self.0.cost()
    }
}
