//! Entry points.

use std::path::Path;

use opendr_engine::{Error, Result, ResultExt};

use super::model_json::ModelJson;
use super::trace::Trace;
use super::weights::read_weights;
use crate::bounded::{MAX_BYTES, read_bounded};
use crate::tensorflow::{ImportOptions, finish, selected_outputs};

/// Converts a TensorFlow.js graph model to an ONNX model (opset 17). The output is deterministic.
///
/// `weights` are the contents of the files that [`tfjs_weight_files`] lists, in that order.
///
/// # Inputs and outputs
/// * Image inputs (rank 4 with 1, 3 or 4 channels) are `float32` of shape `1x3xHxW`, in the value range of the
///   original, also where the original has integer inputs. Their names are those of the original.
/// * Rank 4 outputs that are an image (a feature map, heatmap or mask: more than one pixel high or wide, as computed
///   by a convolution) are `1xCxHxW`. Every other output has the original's shape. Output names are the keys of the
///   model's signature without TensorFlow's `:0`; integers are `int64`.
/// * An open batch size becomes 1. An open image size stays open unless [`ImportOptions::image_size`] fixes it.
///
/// # Errors
/// `Format` for damaged or inconsistent files, `Unsupported` (with node and operator) for operators that cannot be
/// expressed in ONNX, `NotFound` for an output that the model does not have.
pub fn onnx_from_tfjs(model_json: &[u8], weights: &[&[u8]], options: &ImportOptions) -> Result<Vec<u8>> {
    let total: usize = weights.iter().fold(0, |sum, file| sum.saturating_add(file.len()));
    if total as u64 > MAX_BYTES {
        return Err(Error::format(format!("{total} bytes of weights exceed the limit of {MAX_BYTES}")));
    }
    let model = ModelJson::parse(model_json)?;
    let weights = read_weights(&model, weights)?;
    let outputs = selected_outputs(model.outputs(), options)?;
    let mut trace = Trace::new(model.nodes(), weights, options)?;
    for (name, _) in &outputs {
        trace.lowering.graph.reserve(name);
    }
    let mut values = Vec::with_capacity(outputs.len());
    for (name, tensor) in &outputs {
        values.push(trace.tensor(tensor).context(|| format!("output {name:?}"))?);
    }
    finish(trace.lowering, outputs.iter().map(|(name, _)| name.as_str()).zip(values), "tfjs")
}

/// Returns the paths of a model's weight files, relative to its `model.json`; none leaves its folder.
///
/// # Errors
/// `Format` when it is not a TensorFlow.js graph model, `Integrity` when a path points outside.
pub fn tfjs_weight_files(model_json: &[u8]) -> Result<Vec<String>> {
    ModelJson::parse(model_json)?.weight_files()
}

/// Reads `model.json` and the weight files beside it, and converts them like [`onnx_from_tfjs`].
///
/// # Errors
/// Those of [`onnx_from_tfjs`]; `NotFound` or `Io` when a file cannot be read.
pub fn onnx_from_tfjs_file(model_json: &Path, options: &ImportOptions) -> Result<Vec<u8>> {
    let folder = model_json.parent().unwrap_or(Path::new(""));
    let json = read_bounded(model_json)?;
    let paths = tfjs_weight_files(&json)?;
    let files = paths.iter().map(|path| read_bounded(&folder.join(path))).collect::<Result<Vec<_>>>()?;
    let files: Vec<&[u8]> = files.iter().map(Vec::as_slice).collect();
    onnx_from_tfjs(&json, &files, options).context(|| format!("importing {}", model_json.display()))
}
