//! Resizing of images.

use burn::backend::ir::{
    FloatOperationIr, GridSamplePaddingModeIr, InterpolateModeIr, InterpolateOpIr, ModuleOperationIr,
    TensorIr,
};
use burn::tensor::module::{adaptive_avg_pool2d, interpolate};
use burn::tensor::ops::InterpolateOptions;
use burn::tensor::{Device, Tensor};
use opendr_engine::{Error, Result};
use opendr_onnx::{ElementType, GraphTensor, Operator};

use super::lowering::{Lowering, array_from_data};

pub(super) fn lower(graph: &mut Lowering<'_>, operation: &ModuleOperationIr) -> Result<bool> {
    use ModuleOperationIr as Op;
    match operation {
        Op::Interpolate(op) => resize(graph, op)?,
        Op::AdaptiveAvgPool1d(op) => mean(graph, &op.x, &[op.output_size], &op.out)?,
        Op::AdaptiveAvgPool2d(op) => mean(graph, &op.x, &op.output_size, &op.out)?,
        Op::AdaptiveAvgPool3d(op) if op.output_size == [1; 3] => {
            graph.apply(Operator::new("GlobalAveragePool"), &[&op.x], &op.out)?;
        }
        _ => return Ok(false),
    }
    Ok(true)
}

/// Writes grid sampling.
pub(super) fn lower_grid(graph: &mut Lowering<'_>, operation: &FloatOperationIr) -> Result<bool> {
    let FloatOperationIr::GridSample2d(op) = operation else { return Ok(false) };
    let mode = match op.options.mode {
        InterpolateModeIr::Bilinear => "bilinear",
        InterpolateModeIr::Nearest => "nearest",
        InterpolateModeIr::Bicubic => "bicubic",
        _ => return Ok(false),
    };
    let padding = match op.options.padding_mode {
        GridSamplePaddingModeIr::Zeros => "zeros",
        GridSamplePaddingModeIr::Border => "border",
        GridSamplePaddingModeIr::Reflection => "reflection",
    };
    let operator = Operator::new("GridSample").text("mode", mode).text("padding_mode", padding);
    let operator = operator.int("align_corners", i64::from(op.options.align_corners));
    graph.apply(operator, &[&op.tensor, &op.grid], &op.out)?;
    Ok(true)
}

fn resize(graph: &mut Lowering<'_>, op: &InterpolateOpIr) -> Result<()> {
    let [_, _, height, width] = sides(&op.x)?;
    let size = op.output_size;
    let corners = op.options.align_corners;
    let operator = match &op.options.mode {
        InterpolateModeIr::Nearest => Operator::new("Resize")
            .text("mode", "nearest")
            .text("coordinate_transformation_mode", "asymmetric")
            .text("nearest_mode", "floor"),
        InterpolateModeIr::Bilinear => Operator::new("Resize")
            .text("mode", "linear")
            .text("coordinate_transformation_mode", if corners { "align_corners" } else { "half_pixel" }),
        // Cubic interpolation and Lanczos, which ONNX lacks, are linear in the image.
        mode => {
            let options = InterpolateOptions::new(mode.clone().into()).with_align_corners(corners);
            let resized = |picture, size| interpolate(picture, options.clone().with_output_size(size));
            let rows = matrix(height, |picture| resized(picture, [size[0], height]))?;
            let columns = matrix(width, |picture| resized(picture, [size[1], width]))?;
            return separable(graph, &op.x, &[rows, columns], &op.out);
        }
    };
    let scales = [1.0, 1.0, scale(height, size[0])?, scale(width, size[1])?];
    let scales = opendr_onnx::Array::new(vec![4], opendr_onnx::Data::Float(scales.to_vec()));
    let scales =
        scales.map(GraphTensor::constant).ok_or_else(|| Error::internal("resizing needs four scales"))?;
    let x = graph.wire(&op.x)?;
    graph.write(operator, &[&x, &GraphTensor::absent(), &scales], &op.out)
}

/// Returns the factor with which a runtime, which rounds down in single precision, gets from one size to the other. The sizes
/// themselves cannot be used: in opset 17 the batch size would be among them.
fn scale(from: usize, to: usize) -> Result<f32> {
    let exact = (to as f64 / from as f64) as f32;
    [exact, exact.next_up()]
        .into_iter()
        .find(|scale| {
            (from as f32 * scale).floor() as usize == to && (from as f64 * f64::from(*scale)) as usize == to
        })
        .ok_or_else(|| {
            Error::unsupported(format!("resizing {from} to {to} has no factor in single precision"))
        })
}

/// Writes adaptive average pooling, over windows that divide the input as evenly as possible.
fn mean(graph: &mut Lowering<'_>, x: &TensorIr, size: &[usize], out: &TensorIr) -> Result<()> {
    if size.iter().all(|&size| size == 1) {
        return graph.apply(Operator::new("GlobalAveragePool"), &[x], out);
    }
    let from: Vec<usize> = x.shape.iter().skip(2).copied().collect();
    if from.iter().zip(size).all(|(from, size)| from % size == 0) {
        let kernel: Vec<i64> = from.iter().zip(size).map(|(from, size)| (from / size) as i64).collect();
        let operator =
            Operator::new("AveragePool").ints("kernel_shape", kernel.clone()).ints("strides", kernel);
        return graph.apply(operator, &[x], out);
    }
    let matrices = from
        .iter()
        .zip(size)
        .map(|(&from, &size)| matrix(from, |picture| adaptive_avg_pool2d(picture, [size, from])));
    separable(graph, x, &matrices.collect::<Result<Vec<_>>>()?, out)
}

fn sides(tensor: &TensorIr) -> Result<[usize; 4]> {
    tensor.shape.as_slice().try_into().map_err(|_| Error::internal("an image needs four axes"))
}

/// Returns the matrix `[rows after, rows before]` of a linear function on the rows of an image: Burn computes it from the unit
/// matrix.
fn matrix(rows: usize, function: impl Fn(Tensor<4>) -> Tensor<4>) -> Result<Tensor<2>> {
    let unit = Tensor::<2>::eye(rows, &Device::flex()).reshape([1, 1, rows, rows]);
    let result = function(unit);
    let [_, _, after, before] = result.dims();
    Ok(result.reshape([after, before]))
}

/// Applies one matrix to the last axis, or one to the rows and one to the columns of an image.
fn separable(graph: &mut Lowering<'_>, x: &TensorIr, matrices: &[Tensor<2>], out: &TensorIr) -> Result<()> {
    let mut picture = graph.wire(x)?;
    let dims = graph.dims(out);
    let constant =
        |matrix: Tensor<2>| Ok::<_, Error>(GraphTensor::constant(array_from_data(&matrix.into_data())?));
    let columns = match matrices {
        [rows, columns] => {
            let mut between = picture.dims().to_vec();
            between[2] = dims.get(2).copied().flatten();
            let rows = constant(rows.clone())?;
            picture = graph.step(Operator::new("MatMul"), &[&rows, &picture], ElementType::Float, between)?;
            columns
        }
        [columns] => columns,
        _ => return Err(Error::unsupported("resampling is supported over one or two axes only")),
    };
    let columns = constant(columns.clone().transpose())?;
    graph.write(Operator::new("MatMul"), &[&picture, &columns], out)
}
