//! Resizing of images.

use opendr_engine::{Error, Result};

use super::window::Axes;
use crate::tensorflow::call::Call;
use crate::tensorflow::lowering::Lowering;
use crate::tensorflow::value::Value;
use opendr_onnx::{ElementType, GraphTensor, Operator};

pub fn resize(ctx: &mut Lowering, call: &Call) -> Result<Vec<Value>> {
    let (x, size) = (call.input(0)?, call.input(1)?);
    let axes = Axes { height: 1, width: 2, channels: 3 };
    axes.spatial(&x.dims())?;
    if size.dims() != [Some(2)] {
        return Err(Error::format(format!("a size of shape {:?} is not valid for a resize", size.dims())));
    }
    let coordinates = match (call.attr().flag("align_corners"), call.attr().flag("half_pixel_centers")) {
        (true, _) => "align_corners",
        (false, true) => "half_pixel",
        (false, false) => "asymmetric",
    };
    let operator = Operator::new("Resize").text("coordinate_transformation_mode", coordinates);
    let operator = match call.op() {
        "ResizeBilinear" => operator.text("mode", "linear"),
        // TensorFlow rounds half up; without centres it rounds down. floor((i + 0.5) * s) is half_pixel rounded half
        // up.
        _ => {
            let rounding = if coordinates == "asymmetric" { "floor" } else { "round_prefer_ceil" };
            operator.text("mode", "nearest").text("nearest_mode", rounding)
        }
    };
    let elements = size.wire.elements().unwrap_or_default();
    let open = |axis: usize| elements.get(axis).copied().flatten().and_then(|dim| usize::try_from(dim).ok());
    let dims = axes.dims(x.dims()[0], x.dims()[3], [open(0), open(1)]);
    let image = ctx.ordered(x, &axes.order())?;
    let shape =
        ctx.graph.add(&image.hint(), Operator::new("Shape"), &[&image], ElementType::Int, vec![Some(4)])?;
    let (zero, two, one) = (GraphTensor::ints([0]), GraphTensor::ints([2]), GraphTensor::ints([1]));
    let slice = Operator::new("Slice");
    let outer = ctx.graph.add(
        &image.hint(),
        slice,
        &[&shape, &zero, &two, &zero, &one],
        ElementType::Int,
        vec![Some(2)],
    )?;
    let concat = Operator::new("Concat").int("axis", 0);
    let sizes =
        ctx.graph.add(&image.hint(), concat, &[&outer, &size.wire], ElementType::Int, vec![Some(4)])?;
    let inputs = [&image, &GraphTensor::absent(), &GraphTensor::absent(), &sizes];
    Ok(vec![ctx.emit(call, operator, &inputs, ElementType::Float, &dims, axes.order())?])
}

pub fn depth_to_space(ctx: &mut Lowering, call: &Call) -> Result<Vec<Value>> {
    let x = call.input(0)?;
    let axes = Axes::of(call);
    let spatial = axes.spatial(&x.dims())?;
    let block = call.attr().int("block_size").filter(|block| (1..=1 << 10).contains(block));
    let block = block.ok_or_else(|| Error::format("the block size is out of range"))?;
    let size = block as usize;
    let channels = x.dims()[axes.channels];
    if channels.is_some_and(|channels| channels % (size * size) != 0) {
        return Err(Error::format(format!(
            "{channels:?} channels are not divisible into blocks of {size} by {size}"
        )));
    }
    let grown = spatial.map(|dim| dim.and_then(|dim| dim.checked_mul(size)));
    let dims = axes.dims(x.dims()[0], channels.map(|channels| channels / (size * size)), grown);
    let image = ctx.ordered(x, &axes.order())?;
    let operator = Operator::new("DepthToSpace").int("blocksize", block).text("mode", "DCR");
    Ok(vec![ctx.emit(call, operator, &[&image], x.kind(), &dims, axes.order())?])
}
