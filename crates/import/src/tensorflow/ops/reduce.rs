//! Reductions over axes: sum, mean, extremes.

use opendr_engine::Result;

use super::reshape::squeezed;
use crate::tensorflow::call::Call;
use crate::tensorflow::layout::Order;
use crate::tensorflow::lowering::Lowering;
use crate::tensorflow::value::Value;
use opendr_onnx::{ElementType, GraphTensor, Operator};

pub fn reduce(ctx: &mut Lowering, call: &Call) -> Result<Vec<Value>> {
    let x = call.input(0)?;
    let axes = call.axes(1, x.rank())?;
    let keep = call.attr().flag("keep_dims");
    if axes.is_empty() {
        return Ok(vec![x.clone()]);
    }
    if call.op() == "Mean" && axes == [1, 2] && x.order == Order::channels_first() {
        return Ok(vec![global_mean(ctx, call, x, keep)?]);
    }
    let mut stored: Vec<i64> = axes.iter().map(|&axis| x.order.stored(axis) as i64).collect();
    stored.sort_unstable();
    let mut dims = x.dims();
    let mut order = x.order.clone();
    axes.iter().for_each(|&axis| dims[axis] = Some(1));
    if !keep {
        order = order.without(&axes);
        let mut axis = 0;
        dims.retain(|_| {
            axis += 1;
            !axes.contains(&(axis - 1))
        });
    }
    let name = match call.op() {
        "Mean" => "ReduceMean",
        "Sum" => "ReduceSum",
        "Prod" => "ReduceProd",
        "Max" => "ReduceMax",
        _ => "ReduceMin",
    };
    let operator = Operator::new(name).int("keepdims", keep.into());
    let value = if name == "ReduceSum" {
        ctx.emit(call, operator, &[&x.wire, &GraphTensor::ints(stored)], x.kind(), &dims, order)
    } else {
        ctx.emit(call, operator.ints("axes", stored), &[&x.wire], x.kind(), &dims, order)
    };
    Ok(vec![value?])
}

/// Writes the mean over an image with a faster operator.
fn global_mean(ctx: &mut Lowering, call: &Call, x: &Value, keep: bool) -> Result<Value> {
    let mut dims = x.dims();
    dims[1..3].fill(Some(1));
    let operator = Operator::new("GlobalAveragePool");
    let mean = ctx.emit(call, operator, &[&x.wire], ElementType::Float, &dims, x.order.clone())?;
    if keep { Ok(mean) } else { squeezed(ctx, call, &mean, &[1, 2]) }
}
