//! Inputs of models.

use opendr_onnx::{Dim, ElementType};

use super::layout::Order;
use super::lowering::Lowering;
use super::options::ImportOptions;
use super::value::Value;

/// Adds an input of TensorFlow's dimensions `dims` (zero or negative where open). Images become `1x3xHxW` floats,
/// whatever element type TensorFlow declares; other inputs are unchanged.
pub fn input(
    ctx: &mut Lowering,
    options: &ImportOptions,
    name: &str,
    kind: ElementType,
    dims: &[i64],
) -> Value {
    let mut dims: Vec<Dim> =
        dims.iter().map(|&dim| usize::try_from(dim).ok().filter(|&dim| dim > 0)).collect();
    if let Some(batch) = dims.first_mut() {
        *batch = batch.or(Some(1));
    }
    let channels = |axis: usize| matches!(dims.get(axis), Some(Some(1 | 3 | 4)));
    let image = dims.len() == 4 && (channels(3) || channels(1));
    if !image {
        return Value::plain(ctx.graph.input(name, kind, dims, &[]));
    }
    let order = if channels(3) { Order::channels_first() } else { Order::plain(4) };
    let mut stored = order.stored_dims(&dims);
    if let Some((height, width)) = options.image_size {
        stored[2] = stored[2].or(Some(height));
        stored[3] = stored[3].or(Some(width));
    }
    let open = ["batch", "channels", "height", "width"];
    Value::new(ctx.graph.input(name, ElementType::Float, stored, &open), order)
}
