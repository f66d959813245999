//! The entry points.

use std::collections::HashSet;
use std::path::Path;

use opendr_engine::{Error, Result, ResultExt};
use opendr_onnx::{Builder, bytes_from_model, model_from_graph, passes};

use super::param::layers;
use super::trace::Trace;
use super::weights::Weights;
use crate::bounded::{MAX_BYTES, read_bounded};
use crate::tensorflow::{ImportOptions, selected_outputs};

/// Converts an ncnn model, its `.param` text and its weights of 16 or 32 bits, to an ONNX model (opset 17). The
/// output is deterministic.
///
/// # Inputs and outputs
/// * Inputs are `float32` of shape `1xCxHxW`. Sizes that the text leaves open stay open, unless
///   [`ImportOptions::image_size`] fixes them.
/// * Outputs are the tensors that no layer reads. Images are `1xCxHxW`, matrices `1xHxW`, vectors `1xN`.
/// * The names are those of the text.
///
/// # Errors
/// `Format` for damaged or inconsistent files, `Unsupported` (with the layer's name) for layers that cannot be
/// expressed in ONNX, `NotFound` for an output that the model does not have.
pub fn onnx_from_ncnn(param: &[u8], bin: &[u8], options: &ImportOptions) -> Result<Vec<u8>> {
    if param.len().max(bin.len()) as u64 > MAX_BYTES {
        return Err(Error::format(format!(
            "{} bytes exceed the limit of {MAX_BYTES}",
            param.len().max(bin.len())
        )));
    }
    let text = std::str::from_utf8(param).map_err(|error| {
        Error::format(
            "the .param file is not text; ncnn's binary form is not supported, so convert it to text",
        )
        .with_source(error)
    })?;
    let layers = layers(text)?;
    let taken: HashSet<&str> = layers.iter().flat_map(|layer| layer.inputs.iter().copied()).collect();
    let given =
        layers.iter().filter(|layer| layer.kind != "Input").flat_map(|layer| layer.outputs.iter().copied());
    let outputs = given.filter(|name| !taken.contains(name)).map(|name| (name.to_owned(), ())).collect();
    let outputs = selected_outputs(outputs, options)?;
    let mut graph = Builder::default();
    outputs.iter().for_each(|(name, ())| graph.reserve(name));
    let mut trace = Trace::through(&layers, graph, Weights::new(bin), options)?;
    for (name, ()) in &outputs {
        let wire = trace.tensor(name)?;
        trace.graph.output(name, &wire, "", &[])?;
    }
    let mut graph = trace.graph.finish("ncnn");
    passes::simplify(&mut graph);
    Ok(bytes_from_model(&model_from_graph(graph)))
}

/// Reads the files and converts them like [`onnx_from_ncnn`].
///
/// # Errors
/// Those of [`onnx_from_ncnn`]; `NotFound` or `Io` when a file cannot be read.
pub fn onnx_from_ncnn_files(param: &Path, bin: &Path, options: &ImportOptions) -> Result<Vec<u8>> {
    let (text, weights) = (read_bounded(param)?, read_bounded(bin)?);
    onnx_from_ncnn(&text, &weights, options).context(|| format!("importing {}", param.display()))
}
