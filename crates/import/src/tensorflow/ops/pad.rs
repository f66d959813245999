//! Padding.

use opendr_engine::{Error, Result};

use crate::tensorflow::call::Call;
use crate::tensorflow::lowering::Lowering;
use crate::tensorflow::value::Value;
use opendr_onnx::{Dim, ElementType, GraphTensor, Operator};

pub fn pad(ctx: &mut Lowering, call: &Call) -> Result<Vec<Value>> {
    let x = call.input(0)?;
    let pads = call.ints(1)?;
    if pads.len() != 2 * x.rank() || pads.iter().any(|&pad| !(0..=1 << 24).contains(&pad)) {
        return Err(Error::format(format!(
            "the padding {pads:?} does not match a tensor of rank {}",
            x.rank()
        )));
    }
    if pads.iter().all(|&pad| pad == 0) {
        return Ok(vec![x.clone()]);
    }
    let padded = |(axis, dim): (usize, Dim)| dim?.checked_add((pads[2 * axis] + pads[2 * axis + 1]) as usize);
    let dims: Vec<Dim> = x.dims().into_iter().enumerate().map(padded).collect();
    let before = x.order.axes().iter().map(|&axis| pads[2 * axis]);
    let after = x.order.axes().iter().map(|&axis| pads[2 * axis + 1]);
    let mut inputs = vec![x.wire.clone(), GraphTensor::ints(before.chain(after))];
    let operator = Operator::new("Pad");
    let operator = match call.op() {
        "MirrorPad" if call.attr().text("mode") == Some("REFLECT") => operator.text("mode", "reflect"),
        "MirrorPad" => return Err(Error::unsupported("symmetric padding is not supported")),
        "PadV2" => {
            let value = ctx.cast(&call.input(2)?.wire, x.kind())?;
            inputs.push(value);
            operator
        }
        _ if x.kind() == ElementType::Float => {
            inputs.push(GraphTensor::scalar(0.0));
            operator
        }
        _ => operator,
    };
    let inputs: Vec<&GraphTensor> = inputs.iter().collect();
    Ok(vec![ctx.emit(call, operator, &inputs, x.kind(), &dims, x.order.clone())?])
}
