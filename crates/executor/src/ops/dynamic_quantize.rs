//! Quantisation with a scale and a zero point that each run computes from its tensor.

use opendr_engine::Result;
use opendr_onnx::proto::NodeProto;

use super::inputs::required;
use super::quantize::with_scale;
use crate::attributes::Attributes;
use crate::io::{Io, Kernel};
use crate::planner::{Id, Layout, Planner};
use crate::tensor::Kind;

pub(crate) fn build(planner: &mut Planner<'_>, node: &NodeProto, inputs: &[Option<Id>]) -> Result<Vec<Id>> {
    let x = required(node, inputs, 0)?;
    if planner.kind(x) != Kind::F32 {
        return Err(node.refused("elements that are not floats"));
    }
    let outputs = [(Kind::F32, Vec::new(), Layout::Plain), (Kind::U8, Vec::new(), Layout::Plain)];
    let range = planner.emit(RangeStep, &[Some(x)], &outputs)?;
    let &[scale, zero] = range.as_slice() else { return Err(node.damaged("its outputs")) };
    let y = with_scale(planner, x, [scale, zero])?;
    Ok(vec![y, scale, zero])
}

/// Computes scale and zero point, so that bytes reach from the smallest to the largest number and have a zero.
struct RangeStep;

impl Kernel for RangeStep {
    fn run(&self, io: &mut Io<'_>) -> Result<()> {
        let x = io.read::<f32>(0);
        let (scale, zero) = io.write_two::<f32, u8>();
        let (low, high) = x.iter().fold((0.0_f32, 0.0_f32), |(low, high), &x| (low.min(x), high.max(x)));
        let step = if low == high { 1.0 } else { (high - low) / 255.0 };
        scale.fill(step);
        zero.fill((-low / step).round_ties_even().clamp(0.0, 255.0) as u8);
        Ok(())
    }
}
