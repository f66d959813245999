//! Entry points.

use std::collections::HashSet;
use std::path::Path;

use opendr_engine::{Error, Result, ResultExt};

use super::flatbuffer::Flatbuffer;
use super::model::Model;
use super::trace::Trace;
use crate::bounded::{MAX_BYTES, read_bounded};
use crate::tensorflow::{ImportOptions, finish, selected_outputs};

/// Converts a TensorFlow Lite model to an ONNX model (opset 17). The output is deterministic.
///
/// # Inputs and outputs
/// * Image inputs (rank 4 with 1, 3 or 4 channels) are `float32` of shape `1x3xHxW`, in the value range of the
///   original, also where the original has integer inputs.
/// * Rank 4 outputs that are an image (a feature map, heatmap or mask: more than one pixel high or wide, as computed
///   by a convolution) are `1xCxHxW`. Every other output has the original's shape; integers are `int64`.
/// * Inputs and outputs have the original's names, without TensorFlow's `:0`.
/// * An open batch size becomes 1. An open image size stays open unless [`ImportOptions::image_size`] fixes it.
///
/// # Quantised models
/// Weights stay integers. Wherever the original has quantised numbers, a `QuantizeLinear` and a `DequantizeLinear`
/// round to the values of the integers, and the operators between compute in floats. Quantised inputs and outputs are
/// `float32` as well, in the real numbers that the original's integers represent: 0..255 with scale 1/128 and zero
/// point 128 becomes -1..1. Weights of 16 bits are widened.
///
/// # Errors
/// `Format` for damaged or inconsistent files, `Unsupported` (with the operator and its output) for operators that
/// cannot be expressed in ONNX and for sparse weights, `NotFound` for an output that the model does not have.
pub fn onnx_from_tflite(bytes: &[u8], options: &ImportOptions) -> Result<Vec<u8>> {
    if bytes.len() as u64 > MAX_BYTES {
        return Err(Error::format(format!("{} bytes exceed the limit of {MAX_BYTES}", bytes.len())));
    }
    let file = Flatbuffer::new(bytes, b"TFL3")?;
    let model = Model::read(&file)?;
    let mut names: HashSet<&str> = model.inputs.iter().map(|&input| model.tensors[input].port()).collect();
    let mut outputs = Vec::with_capacity(model.outputs.len());
    for &output in &model.outputs {
        let name = model.tensors[output].port();
        if name.is_empty() || !names.insert(name) {
            return Err(Error::format(format!("the name of output {name:?} is empty or not unique")));
        }
        outputs.push((name.to_owned(), output));
    }
    let outputs = selected_outputs(outputs, options)?;
    let mut trace = Trace::new(&model, options)?;
    for (name, _) in &outputs {
        trace.lowering.graph.reserve(name);
    }
    let tensors: Vec<usize> = outputs.iter().map(|(_, tensor)| *tensor).collect();
    let values = trace.write(&tensors)?;
    finish(trace.lowering, outputs.iter().map(|(name, _)| name.as_str()).zip(values), "tflite")
}

/// Reads the file and converts it like [`onnx_from_tflite`].
///
/// # Errors
/// Those of [`onnx_from_tflite`]; `NotFound` or `Io` when the file cannot be read.
pub fn onnx_from_tflite_file(path: &Path, options: &ImportOptions) -> Result<Vec<u8>> {
    let bytes = read_bounded(path)?;
    onnx_from_tflite(&bytes, options).context(|| format!("importing {}", path.display()))
}
