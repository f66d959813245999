//! The entry points.

use std::collections::HashSet;
use std::path::Path;

use opendr_engine::{Error, Result, ResultExt};

use super::flatbuffer::Flatbuffer;
use super::model::Model;
use super::trace::Trace;
use crate::bounded::{MAX_BYTES, read_bounded};
use crate::tensorflow::{ImportOptions, finish, wanted};

/// Turns a TensorFlow Lite model into an ONNX model (opset 17). The same input gives the same bytes.
///
/// # Inputs and outputs
/// * Image inputs (rank 4 with 1, 3 or 4 channels) are `float32` of shape `1x3xHxW`, in the value range that the
///   original wants, also where the original takes integers.
/// * Rank 4 outputs that hold an image (a feature map, heat map or mask: more than one pixel high or wide, as computed
///   by a convolution) are `1xCxHxW`. Every other output has the original's shape; integers are `int64`.
/// * Inputs and outputs are called as in the original, without TensorFlow's `:0`.
/// * An open batch size becomes 1. An open image size stays open unless [`ImportOptions::image_size`] fixes it.
///
/// # Quantised models
/// Weights stay the integers that they are. Wherever the original has quantised numbers, a `QuantizeLinear` and a
/// `DequantizeLinear` round to the values that the integers have, and the operators between compute in floats. Quantised
/// inputs and outputs are `float32` as well: they take and give the real numbers for which the original's integers
/// stand, so that 0..255 with scale 1/128 and zero point 128 becomes -1..1. Weights of 16 bits are widened.
///
/// # Errors
/// `Format` for files that are damaged or contradict themselves, `Unsupported` (naming the operator and what it makes)
/// for what cannot be expressed, sparse weights among it, `NotFound` for an output that the model does not have.
pub fn onnx_from_tflite(bytes: &[u8], options: &ImportOptions) -> Result<Vec<u8>> {
    if bytes.len() as u64 > MAX_BYTES {
        return Err(Error::format(format!("{} bytes, more than the {MAX_BYTES} allowed", bytes.len())));
    }
    let file = Flatbuffer::new(bytes, b"TFL3")?;
    let model = Model::read(&file)?;
    let mut names: HashSet<&str> = model.inputs.iter().map(|&input| model.tensors[input].port()).collect();
    let mut outputs = Vec::with_capacity(model.outputs.len());
    for &output in &model.outputs {
        let name = model.tensors[output].port();
        if name.is_empty() || !names.insert(name) {
            return Err(Error::format(format!("output {name:?} without a name of its own")));
        }
        outputs.push((name.to_owned(), output));
    }
    let outputs = wanted(outputs, options)?;
    let mut trace = Trace::new(&model, options)?;
    for (name, _) in &outputs {
        trace.lowering.graph.reserve(name);
    }
    let tensors: Vec<usize> = outputs.iter().map(|(_, tensor)| *tensor).collect();
    let values = trace.write(&tensors)?;
    finish(trace.lowering, outputs.iter().map(|(name, _)| name.as_str()).zip(values), "tflite")
}

/// As [`onnx_from_tflite`], reading the file.
///
/// # Errors
/// As [`onnx_from_tflite`]; `NotFound` or `Io` when the file cannot be read.
pub fn onnx_from_tflite_file(path: &Path, options: &ImportOptions) -> Result<Vec<u8>> {
    let bytes = read_bounded(path)?;
    onnx_from_tflite(&bytes, options).context(|| format!("importing {}", path.display()))
}
