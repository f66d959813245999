//! Conversion of layers with weights.

use opendr_engine::{Error, Result};
use opendr_onnx::{Array, Data, Dim, GraphTensor, Operator};

use super::activation::activated;
use super::param::{Layer, Parameters};
use super::shape::flat;
use super::trace::Trace;

/// A sliding window: kernel, stride, dilation, and padding at the top, left, bottom, right.
struct Window {
    kernel: [usize; 2],
    stride: [usize; 2],
    dilation: [usize; 2],
    pads: [usize; 4],
}

/// Maximum size, above that of real windows.
const MOST: usize = 4096;

impl Window {
    fn of(parameters: &Parameters) -> Result<Self> {
        let pair = |across: i64, down: i64, default: usize| -> Result<[usize; 2]> {
            let across = parameters.size(across, default)?;
            Ok([parameters.size(down, across)?, across])
        };
        let (kernel, dilation, stride) = (pair(1, 11, 0)?, pair(2, 12, 1)?, pair(3, 13, 1)?);
        if parameters.int(4, 0)? < 0 {
            return Err(Error::unsupported("padding that depends on the image size is not supported"));
        }
        let left = parameters.size(4, 0)?;
        let right = parameters.size(15, left)?;
        let top = parameters.size(14, left)?;
        let bottom = parameters.size(16, top)?;
        let window = Self { kernel, stride, dilation, pads: [top, left, bottom, right] };
        let sizes = [kernel, stride, dilation];
        let is_real = sizes.iter().flatten().all(|size| (1..=MOST).contains(size));
        match is_real && window.pads.iter().all(|pad| *pad <= MOST) && parameters.float(18, 0.0)? == 0.0 {
            true => Ok(window),
            false => Err(Error::unsupported(
                "a window of an unsupported size, or padding with a value other than zero",
            )),
        }
    }

    fn attributes(&self, operator: Operator) -> Operator {
        let list = |sizes: &[usize]| sizes.iter().map(|size| *size as i64).collect::<Vec<_>>();
        operator
            .ints("kernel_shape", list(&self.kernel))
            .ints("strides", list(&self.stride))
            .ints("dilations", list(&self.dilation))
            .ints("pads", list(&self.pads))
    }

    /// Returns the height or width of the output.
    fn side(&self, axis: usize, side: Dim) -> Result<Dim> {
        let Some(side) = side else { return Ok(None) };
        let reach = self.dilation[axis] * (self.kernel[axis] - 1) + 1;
        let room = (side + self.pads[axis] + self.pads[axis + 2]).checked_sub(reach);
        let room =
            room.ok_or_else(|| Error::format(format!("a side of {side} pixels is smaller than the window")))?;
        Ok(Some(room / self.stride[axis] + 1))
    }
}

/// Returns the input channels per group, from the number of weights.
fn channels_a_group(parameters: &Parameters, window: &Window, filters: usize) -> Result<usize> {
    let count = parameters.size(6, 0)?;
    let each = filters.checked_mul(window.kernel[0] * window.kernel[1]);
    let channels = each.filter(|each| *each > 0 && count.is_multiple_of(*each)).map(|each| count / each);
    channels.filter(|channels| *channels > 0).ok_or_else(|| {
        Error::format(format!(
            "{count} weights for {filters} filters of {:?} do not give whole channels",
            window.kernel
        ))
    })
}

/// Returns the number of input channels of a convolution.
pub fn channels(layer: &Layer<'_>) -> Option<usize> {
    let parameters = &layer.parameters;
    let groups = match layer.kind {
        "Convolution" => 1,
        "ConvolutionDepthWise" => parameters.size(7, 1).ok()?,
        _ => return None,
    };
    let window = Window::of(parameters).ok()?;
    channels_a_group(parameters, &window, parameters.size(0, 0).ok()?).ok()?.checked_mul(groups)
}

/// Converts `Convolution`, and `ConvolutionDepthWise`, which has groups.
pub fn convolution(trace: &mut Trace<'_>, layer: &Layer<'_>) -> Result<GraphTensor> {
    let parameters = &layer.parameters;
    let input = trace.input(layer, 0)?;
    let window = Window::of(parameters)?;
    let filters = parameters.size(0, 0)?;
    let groups = if layer.kind == "Convolution" { 1 } else { parameters.size(7, 1)? };
    let each = channels_a_group(parameters, &window, filters)?;
    refuse_integers(parameters)?;
    let &[_, own, height, width] = input.dims() else {
        return Err(Error::format("the convolution needs an image as input"));
    };
    let wanted = each.checked_mul(groups);
    let fits = groups > 0 && filters.is_multiple_of(groups) && (own.is_none() || own == wanted);
    if !fits {
        return Err(Error::format(format!(
            "{filters} filters in {groups} groups of {each} channels do not match an input of {own:?} channels"
        )));
    }
    let weight = trace.weights.marked(parameters.size(6, 0)?)?;
    let weight = array(vec![filters, each, window.kernel[0], window.kernel[1]], weight)?;
    let mut inputs = vec![input, GraphTensor::named_constant(&format!("{}.weight", layer.name), weight)];
    if parameters.int(5, 0)? != 0 {
        let bias = array(vec![filters], trace.weights.plain(filters)?)?;
        inputs.push(GraphTensor::named_constant(&format!("{}.bias", layer.name), bias));
    }
    let dims = vec![Some(1), Some(filters), window.side(0, height)?, window.side(1, width)?];
    let operator = window.attributes(Operator::new("Conv")).int("group", groups as i64);
    let inputs: Vec<_> = inputs.iter().collect();
    let wire = trace.add(layer, operator, &inputs, dims)?;
    activated(trace, layer, wire)
}

/// Converts `InnerProduct`: a vector times a matrix.
pub fn inner_product(trace: &mut Trace<'_>, layer: &Layer<'_>) -> Result<GraphTensor> {
    let parameters = &layer.parameters;
    let input = trace.input(layer, 0)?;
    let (rows, count) = (parameters.size(0, 0)?, parameters.size(2, 0)?);
    refuse_integers(parameters)?;
    let columns = count.checked_div(rows).filter(|columns| *columns > 0 && columns * rows == count);
    let columns = columns
        .ok_or_else(|| Error::format(format!("{count} weights are not divisible into {rows} rows")))?;
    let input = flat(trace, layer, &input)?;
    if input.dims()[1].is_some_and(|own| own != columns) {
        return Err(Error::format(format!(
            "an input of {:?} values cannot be multiplied by a matrix of {columns} columns",
            input.dims()[1]
        )));
    }
    let weight = array(vec![rows, columns], trace.weights.marked(count)?)?;
    let mut inputs = vec![input, GraphTensor::named_constant(&format!("{}.weight", layer.name), weight)];
    if parameters.int(1, 0)? != 0 {
        let bias = array(vec![rows], trace.weights.plain(rows)?)?;
        inputs.push(GraphTensor::named_constant(&format!("{}.bias", layer.name), bias));
    }
    let inputs: Vec<_> = inputs.iter().collect();
    let operator = Operator::new("Gemm").int("transB", 1);
    let wire = trace.add(layer, operator, &inputs, vec![Some(1), Some(rows)])?;
    activated(trace, layer, wire)
}

/// Converts `BatchNorm`, with slope, mean, variance and bias per channel, to a factor and a summand.
pub fn batch_norm(trace: &mut Trace<'_>, layer: &Layer<'_>) -> Result<GraphTensor> {
    let input = trace.input(layer, 0)?;
    let (count, least) = (layer.parameters.size(0, 0)?, layer.parameters.float(1, 0.0)?);
    if input.rank() != 4 {
        return Err(Error::unsupported("batch normalisation is supported for images only"));
    }
    let mut take = || trace.weights.plain(count);
    let (slope, mean, variance, bias) = (take()?, take()?, take()?, take()?);
    let factor: Vec<f32> =
        slope.iter().zip(&variance).map(|(slope, variance)| slope / (variance + least).sqrt()).collect();
    let parts = bias.iter().zip(&mean).zip(&factor);
    let summand: Vec<f32> = parts.map(|((bias, mean), factor)| bias - mean * factor).collect();
    let dims = input.dims().to_vec();
    let factor = GraphTensor::constant(array(vec![count, 1, 1], factor)?);
    let summand = GraphTensor::constant(array(vec![count, 1, 1], summand)?);
    let product = trace.add(layer, Operator::new("Mul"), &[&input, &factor], dims.clone())?;
    trace.add(layer, Operator::new("Add"), &[&product, &summand], dims)
}

/// Converts `PReLU`: one slope for all channels or one per channel.
pub fn parametric(trace: &mut Trace<'_>, layer: &Layer<'_>) -> Result<GraphTensor> {
    let input = trace.input(layer, 0)?;
    let count = layer.parameters.size(0, 0)?;
    let sides = vec![1; input.rank().saturating_sub(2)];
    let slope = array([vec![count], sides].concat(), trace.weights.plain(count)?)?;
    let dims = input.dims().to_vec();
    trace.add(layer, Operator::new("PRelu"), &[&input, &GraphTensor::constant(slope)], dims)
}

/// Converts `Pooling`: maximum or mean of a window, or of the whole image.
pub fn pooling(trace: &mut Trace<'_>, layer: &Layer<'_>) -> Result<GraphTensor> {
    let parameters = &layer.parameters;
    let input = trace.input(layer, 0)?;
    let is_mean = match parameters.int(0, 0)? {
        0 => false,
        1 => true,
        other => return Err(Error::format(format!("unsupported pooling type {other}"))),
    };
    let &[_, channels, height, width] = input.dims() else {
        return Err(Error::format("pooling needs an image as input"));
    };
    if parameters.int(4, 0)? != 0 {
        let name = if is_mean { "GlobalAveragePool" } else { "GlobalMaxPool" };
        let dims = vec![Some(1), channels, Some(1), Some(1)];
        let pooled = trace.add(layer, Operator::new(name), &[&input], dims)?;
        return flat(trace, layer, &pooled);
    }
    let size = |key, default| parameters.size(key, default);
    let (across, step) = (size(1, 0)?, size(2, 1)?);
    let left = size(3, 0)?;
    let pads = [size(13, left)?, left, size(15, size(13, left)?)?, size(14, left)?];
    let window = Window {
        kernel: [size(11, across)?, across],
        stride: [size(12, step)?, step],
        dilation: [1; 2],
        pads,
    };
    let is_real = [window.kernel, window.stride].iter().flatten().all(|size| (1..=MOST).contains(size))
        && pads.iter().all(|pad| *pad <= MOST);
    // ncnn's default mode divides windows that are partly outside in a way of its own.
    let whole = parameters.int(5, 0)? == 1 && parameters.int(7, 0)? == 0;
    if !is_real || !whole {
        return Err(Error::unsupported(
            "pooling windows that reach beyond the image are supported with pad_mode 1 only",
        ));
    }
    let dims = vec![Some(1), channels, window.side(0, height)?, window.side(1, width)?];
    let list = |sizes: &[usize]| sizes.iter().map(|size| *size as i64).collect::<Vec<_>>();
    let operator = Operator::new(if is_mean { "AveragePool" } else { "MaxPool" });
    let operator = operator.ints("kernel_shape", list(&window.kernel)).ints("strides", list(&window.stride));
    let operator = operator.ints("pads", list(&window.pads));
    let counts = is_mean && parameters.int(6, 0)? != 0;
    let operator = if counts { operator.int("count_include_pad", 1) } else { operator };
    trace.add(layer, operator, &[&input], dims)
}

fn refuse_integers(parameters: &Parameters) -> Result<()> {
    match parameters.int(8, 0)? {
        0 => Ok(()),
        _ => Err(Error::unsupported("layers of 8 bits are not supported; use a model of 16 or 32 bits")),
    }
}

fn array(dims: Vec<usize>, values: Vec<f32>) -> Result<Array> {
    let what = format!("{} values do not match a tensor of shape {dims:?}", values.len());
    Array::new(dims, Data::Float(values)).ok_or_else(|| Error::format(what))
}
