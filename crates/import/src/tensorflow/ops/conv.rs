//! Convolutions.

use opendr_engine::{Error, Result};

use super::activation::Epilogue;
use super::window::{Axes, Padding, Pair, Window};
use crate::tensorflow::call::Call;
use crate::tensorflow::layout::Order;
use crate::tensorflow::lowering::Lowering;
use crate::tensorflow::value::Value;
use opendr_onnx::{Dim, ElementType, GraphTensor, Operator};

/// Returns the filter's dimensions, which must be known.
fn filter_dims(call: &Call) -> Result<[usize; 4]> {
    let dims = call
        .input(1)?
        .known_dims()
        .ok_or_else(|| Error::unsupported("a filter of open size is not supported"))?;
    dims.try_into()
        .map_err(|dims: Vec<usize>| Error::format(format!("the filter has rank {} instead of 4", dims.len())))
}

/// Returns the filter stored in the given order.
fn filter(ctx: &mut Lowering, call: &Call, order: [usize; 4]) -> Result<GraphTensor> {
    ctx.ordered(call.input(1)?, &Order::new(order.to_vec()))
}

/// Checks the number of channels of the image.
fn check_channels(image: Dim, filter: usize) -> Result<()> {
    match image {
        Some(channels) if channels != filter => Err(Error::format(format!(
            "a filter for {filter} channels does not match an image of {channels}"
        ))),
        _ => Ok(()),
    }
}

pub fn conv(ctx: &mut Lowering, call: &Call) -> Result<Vec<Value>> {
    let [height, width, channels, filters] = filter_dims(call)?;
    let axes = Axes::of(call);
    let image = call.input(0)?.dims();
    axes.spatial(&image)?;
    let groups = match image[axes.channels] {
        Some(own) if channels > 0 && own % channels == 0 && own > 0 => own / channels,
        own => check_channels(own, channels).map(|()| 1)?,
    };
    let weights = filter(ctx, call, [3, 2, 0, 1])?;
    convolve(ctx, call, axes, [height, width], weights, groups, filters)
}

pub fn depthwise(ctx: &mut Lowering, call: &Call) -> Result<Vec<Value>> {
    let [height, width, channels, multiplier] = filter_dims(call)?;
    let axes = Axes::of(call);
    let image = call.input(0)?.dims();
    axes.spatial(&image)?;
    check_channels(image[axes.channels], channels)?;
    let filters = channels
        .checked_mul(multiplier)
        .ok_or_else(|| Error::format("the number of filters is too large"))?;
    let weights = filter(ctx, call, [2, 3, 0, 1])?;
    let shape = [filters, 1, height, width];
    let dims = shape.map(Some).to_vec();
    let target = GraphTensor::ints(shape.map(|dim| dim as i64));
    let weights = ctx.graph.add(
        &weights.hint(),
        Operator::new("Reshape"),
        &[&weights, &target],
        ElementType::Float,
        dims,
    )?;
    convolve(ctx, call, axes, [height, width], weights, channels, filters)
}

/// Writes the convolution and the operations fused into it.
fn convolve(
    ctx: &mut Lowering,
    call: &Call,
    axes: Axes,
    kernel: Pair<usize>,
    weights: GraphTensor,
    groups: usize,
    filters: usize,
) -> Result<Vec<Value>> {
    let image = call.input(0)?;
    let window = Window::of(call, axes, kernel)?;
    let spatial = axes.spatial(&image.dims())?;
    let dims = axes.dims(image.dims()[0], Some(filters), window.output(spatial)?);
    let mut operator = window.onto(Operator::new("Conv"), spatial)?;
    if groups != 1 {
        operator = operator.int("group", groups as i64);
    }
    let epilogue = Epilogue::of(call)?;
    let image = ctx.ordered(image, &axes.order())?;
    let mut inputs = vec![image, weights];
    if let Some(bias) = &epilogue.bias {
        inputs.push(channel_vector(ctx, bias, filters)?);
    }
    let inputs: Vec<&GraphTensor> = inputs.iter().collect();
    let output = ctx.emit(call, operator, &inputs, ElementType::Float, &dims, axes.order())?;
    Ok(vec![epilogue.activate(ctx, call, output)?])
}

/// Returns a bias of one element per filter.
fn channel_vector(ctx: &mut Lowering, bias: &Value, filters: usize) -> Result<GraphTensor> {
    match bias.known_dims().as_deref() {
        Some([length]) if *length == filters => Ok(bias.wire.clone()),
        Some([1]) | Some([]) => {
            let shape = GraphTensor::ints([filters as i64]);
            let dims = vec![Some(filters)];
            ctx.graph.add(
                &bias.wire.hint(),
                Operator::new("Expand"),
                &[&bias.wire, &shape],
                ElementType::Float,
                dims,
            )
        }
        other => Err(Error::format(format!("a bias of shape {other:?} does not match {filters} filters"))),
    }
}

/// Converts `Conv2DBackpropInput`: the output's shape, the filter, the image.
pub fn transposed(ctx: &mut Lowering, call: &Call) -> Result<Vec<Value>> {
    let [height, width, filters, channels] = filter_dims(call)?;
    let axes = Axes::of(call);
    let image = call.input(2)?;
    let spatial = axes.spatial(&image.dims())?;
    check_channels(image.dims()[axes.channels], channels)?;
    let window = Window::of(call, axes, [height, width])?;
    let shape = call.input(0)?.wire.elements().filter(|shape| shape.len() == 4);
    let wanted = |axis: usize| shape.as_ref().and_then(|shape| usize::try_from(shape[axis]?).ok());
    let wanted = [wanted(axes.height), wanted(axes.width)];
    let height = fit(&window, 0, spatial[0], wanted[0])?;
    let width = fit(&window, 1, spatial[1], wanted[1])?;
    let list = |pair: Pair<usize>| pair.map(|value| value as i64);
    let operator = Operator::new("ConvTranspose")
        .ints("kernel_shape", list(window.kernel))
        .ints("strides", list(window.strides))
        .ints("dilations", list(window.dilations))
        .ints(
            "pads",
            list([height.before, width.before]).into_iter().chain(list([height.after, width.after])),
        )
        .ints("output_padding", list([height.extra, width.extra]));
    let weights = filter(ctx, call, [3, 2, 0, 1])?;
    let dims = axes.dims(image.dims()[0], Some(filters), [height.output, width.output]);
    let image = ctx.ordered(image, &axes.order())?;
    Ok(vec![ctx.emit(call, operator, &[&image, &weights], ElementType::Float, &dims, axes.order())?])
}

/// How one axis of a transposed convolution is cropped (`before`, `after`) or extended (`extra`).
struct Fit {
    before: usize,
    after: usize,
    extra: usize,
    output: Dim,
}

/// The output is cropped by the padding of the convolution whose gradient this is. An open output size is taken as
/// the input's size times the stride, as in TensorFlow's layers.
fn fit(window: &Window, axis: usize, input: Dim, wanted: Dim) -> Result<Fit> {
    let stride = window.strides[axis];
    let reach = (window.kernel[axis] - 1) * window.dilations[axis] + 1;
    let full = input.map(|input| input.saturating_sub(1).saturating_mul(stride).saturating_add(reach));
    let before = match &window.padding {
        Padding::Fixed(pads) => pads[axis][0],
        Padding::Same => match (input, wanted) {
            (Some(_), Some(wanted)) => full.unwrap_or(0).saturating_sub(wanted) / 2,
            _ => reach.saturating_sub(stride) / 2,
        },
    };
    let fixed_after = match &window.padding {
        Padding::Fixed(pads) => pads[axis][1],
        Padding::Same => reach.saturating_sub(stride) - before.min(reach.saturating_sub(stride)),
    };
    let (Some(full), Some(output)) = (full, wanted) else {
        let extra = if window.padding == Padding::Same { stride.saturating_sub(reach) } else { 0 };
        return Ok(Fit { before, after: fixed_after, extra, output: None });
    };
    let cropped = full.saturating_sub(before);
    let fits = output.abs_diff(cropped) <= reach.max(stride);
    match fits {
        true => Ok(Fit {
            before,
            after: cropped.saturating_sub(output),
            extra: output.saturating_sub(cropped),
            output: Some(output),
        }),
        false => {
            Err(Error::format(format!("a transposed convolution cannot reduce {full} pixels to {output}")))
        }
    }
}

/// Converts batch normalisation with known statistics to a multiplication and an addition.
pub fn batch_norm(ctx: &mut Lowering, call: &Call) -> Result<Vec<Value>> {
    let x = call.input(0)?;
    let axes = Axes::of(call);
    axes.spatial(&x.dims())?;
    if call.attr().flag("is_training") {
        return Err(Error::unsupported(
            "batch normalisation in training mode is not supported; export the model for inference",
        ));
    }
    let epsilon = call.attr().float("epsilon").unwrap_or(1e-3);
    let x_wire = ctx.ordered(x, &axes.order())?;
    let mut inputs = vec![x_wire];
    for index in 1..5 {
        inputs.push(call.input(index)?.wire.clone());
    }
    let inputs: Vec<&GraphTensor> = inputs.iter().collect();
    let operator = Operator::new("BatchNormalization").float("epsilon", epsilon);
    Ok(vec![ctx.emit(call, operator, &inputs, ElementType::Float, &x.dims(), axes.order())?])
}
