//! The entry points.

use std::collections::HashSet;
use std::path::Path;

use opendr_engine::{Error, Result, ResultExt};
use opendr_onnx::{Builder, bytes_from_model, model_from_graph, passes};

use super::param::layers;
use super::trace::Trace;
use super::weights::Weights;
use crate::bounded::{MAX_BYTES, read_bounded};
use crate::tensorflow::{ImportOptions, wanted};

/// Turns a model of ncnn's, its text of layers and its weights of 16 or 32 bits, into an ONNX model (opset 17). The same input
/// gives the same bytes.
///
/// # Inputs and outputs
/// * Inputs are `float32` of shape `1xCxHxW`. What the text leaves open stays open, unless
///   [`ImportOptions::image_size`] fixes it.
/// * Outputs are the tensors that no layer takes. Pictures are `1xCxHxW`, tables `1xHxW`, rows of numbers `1xN`.
/// * They are called as in the text.
///
/// # Errors
/// `Format` for files that are damaged or contradict themselves, `Unsupported` (naming the layer) for what cannot be
/// expressed, `NotFound` for an output that the model does not have.
pub fn onnx_from_ncnn(param: &[u8], bin: &[u8], options: &ImportOptions) -> Result<Vec<u8>> {
    if param.len().max(bin.len()) as u64 > MAX_BYTES {
        return Err(Error::format(format!(
            "{} bytes, more than the {MAX_BYTES} allowed",
            param.len().max(bin.len())
        )));
    }
    let text = std::str::from_utf8(param).map_err(|error| {
        Error::format("the layers are no text; ncnn's binary form of them cannot be read").with_source(error)
    })?;
    let layers = layers(text)?;
    let taken: HashSet<&str> = layers.iter().flat_map(|layer| layer.inputs.iter().copied()).collect();
    let given =
        layers.iter().filter(|layer| layer.kind != "Input").flat_map(|layer| layer.outputs.iter().copied());
    let outputs = given.filter(|name| !taken.contains(name)).map(|name| (name.to_owned(), ())).collect();
    let outputs = wanted(outputs, options)?;
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

/// As [`onnx_from_ncnn`], reading the files.
///
/// # Errors
/// As [`onnx_from_ncnn`]; `NotFound` or `Io` when a file cannot be read.
pub fn onnx_from_ncnn_files(param: &Path, bin: &Path, options: &ImportOptions) -> Result<Vec<u8>> {
    let (text, weights) = (read_bounded(param)?, read_bounded(bin)?);
    onnx_from_ncnn(&text, &weights, options).context(|| format!("importing {}", param.display()))
}
