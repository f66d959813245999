//! Maximum and average pooling.

use opendr_engine::Result;

use super::window::{Axes, Window};
use crate::tensorflow::call::Call;
use crate::tensorflow::lowering::Lowering;
use crate::tensorflow::value::Value;
use opendr_onnx::{ElementType, Operator};

/// Converts `MaxPool` and `AvgPool`. By default ONNX, like TensorFlow, excludes the padding from averages.
pub fn pool(ctx: &mut Lowering, call: &Call) -> Result<Vec<Value>> {
    let x = call.input(0)?;
    let axes = Axes::of(call);
    let spatial = axes.spatial(&x.dims())?;
    let window = Window::of_pool(call, axes)?;
    let name = if call.op() == "MaxPool" { "MaxPool" } else { "AveragePool" };
    let operator = window.onto(Operator::new(name), spatial)?;
    let dims = axes.dims(x.dims()[0], x.dims()[axes.channels], window.output(spatial)?);
    let x = ctx.ordered(x, &axes.order())?;
    Ok(vec![ctx.emit(call, operator, &[&x], ElementType::Float, &dims, axes.order())?])
}
