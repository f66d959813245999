//! `model.json` of a TensorFlow.js graph model.

use std::collections::BTreeMap;

use opendr_engine::{Error, Result, ResultExt};
use serde::Deserialize;

use super::attributes;
use crate::tensorflow::Attributes;

/// Maximum size, above that of real files; the weights are in files of their own.
const MAX_JSON_BYTES: usize = 64 << 20;

/// The parsed file; fields that the importer does not need are skipped.
#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct ModelJson {
    format: Option<String>,
    model_topology: Topology,
    /// Groups of weights, each with its own list of files.
    pub weights_manifest: Vec<WeightGroup>,
    signature: Option<Signature>,
    user_defined_metadata: Option<Metadata>,
}

#[derive(Debug, Deserialize)]
struct Topology {
    #[serde(default)]
    node: Vec<Node>,
    #[serde(default)]
    library: Library,
}

#[derive(Debug, Default, Deserialize)]
struct Library {
    #[serde(default)]
    function: Vec<serde::de::IgnoredAny>,
}

#[derive(Debug, Deserialize)]
struct Metadata {
    signature: Option<Signature>,
}

#[derive(Debug, Deserialize)]
struct Signature {
    #[serde(default)]
    outputs: BTreeMap<String, TensorName>,
}

#[derive(Debug, Deserialize)]
struct TensorName {
    name: String,
}

/// A node of a TensorFlow graph.
#[derive(Debug, Deserialize)]
pub struct Node {
    /// Unique name in the graph.
    pub name: String,
    /// TensorFlow's name of the operator.
    pub op: String,
    /// Inputs: `node`, `node:output`, or `^node` for a control input.
    #[serde(default)]
    pub input: Vec<String>,
    /// Named parameters.
    #[serde(default, deserialize_with = "attributes::deserialize")]
    pub attr: Attributes,
}

/// Weights that are stored one after the other in the concatenation of `paths`.
#[derive(Debug, Deserialize)]
pub struct WeightGroup {
    /// File names relative to `model.json`.
    pub paths: Vec<String>,
    /// The weights in order.
    pub weights: Vec<Weight>,
}

/// A weight.
#[derive(Debug, Deserialize)]
pub struct Weight {
    /// Name of its `Const` node.
    pub name: String,
    /// Dimensions.
    pub shape: Vec<usize>,
    /// `float32`, `int32` or `bool`.
    pub dtype: String,
    /// Quantised storage of the elements, if any.
    pub quantization: Option<Quantization>,
}

/// Storage as `float16`, or as `uint8` or `uint16` with `value = stored * scale + min`.
#[derive(Debug, Deserialize)]
pub struct Quantization {
    /// `float16`, `uint8` or `uint16`.
    pub dtype: String,
    /// Step between neighbouring values.
    pub scale: Option<f32>,
    /// Value of the stored zero.
    pub min: Option<f32>,
}

impl ModelJson {
    /// Parses the file.
    ///
    /// # Errors
    /// `Format` when it is too large, not JSON, or not a graph model.
    pub fn parse(bytes: &[u8]) -> Result<Self> {
        if bytes.len() > MAX_JSON_BYTES {
            return Err(Error::format(format!(
                "model.json has {} bytes, which exceeds the limit of {MAX_JSON_BYTES}",
                bytes.len()
            )));
        }
        let model: Self = serde_json::from_slice(bytes)
            .map_err(|error| Error::format(error.to_string()))
            .context(|| "reading a TensorFlow.js model.json")?;
        if let Some(format) = model.format.as_deref().filter(|format| *format != "graph-model") {
            return Err(Error::unsupported(format!(
                "unsupported TensorFlow.js format {format:?}; convert the model to \"graph-model\" first"
            )));
        }
        if !model.model_topology.library.function.is_empty() {
            return Err(Error::unsupported(
                "TensorFlow.js models with a function library are not supported; convert the model with its functions inlined",
            ));
        }
        Ok(model)
    }

    /// Returns the nodes, in the file's order.
    pub fn nodes(&self) -> &[Node] {
        &self.model_topology.node
    }

    /// Returns output names (without TensorFlow's `:0`) and their tensors, sorted by name. Without a signature, every
    /// tensor that no other node reads is an output.
    pub fn outputs(&self) -> Vec<(String, String)> {
        let signature = self.signature.as_ref().filter(|signature| !signature.outputs.is_empty());
        let signature = signature
            .or_else(|| self.user_defined_metadata.as_ref().and_then(|data| data.signature.as_ref()));
        let named = signature.map(|signature| &signature.outputs).filter(|outputs| !outputs.is_empty());
        match named {
            Some(outputs) => outputs
                .iter()
                .map(|(key, tensor)| (key.strip_suffix(":0").unwrap_or(key).to_owned(), tensor.name.clone()))
                .collect(),
            None => self.unread(),
        }
    }

    fn unread(&self) -> Vec<(String, String)> {
        let inputs = self.nodes().iter().flat_map(|node| &node.input);
        let read: std::collections::BTreeSet<&str> = inputs.map(|input| producer(input).0).collect();
        let mut outputs: Vec<_> = self
            .nodes()
            .iter()
            .filter(|node| !read.contains(node.name.as_str()) && node.op != "NoOp")
            .map(|node| (node.name.clone(), node.name.clone()))
            .collect();
        outputs.sort();
        outputs
    }

    /// Returns the paths of the weight files, relative to `model.json`, in the order of the input of
    /// [`onnx_from_tfjs`].
    ///
    /// # Errors
    /// `Integrity` when a path leaves the folder of `model.json`.
    ///
    /// [`onnx_from_tfjs`]: super::onnx_from_tfjs
    pub fn weight_files(&self) -> Result<Vec<String>> {
        let paths = self.weights_manifest.iter().flat_map(|group| &group.paths);
        paths
            .map(|path| {
                let inside = path.split('/').all(|part| !matches!(part, "" | "." | ".."));
                match inside && !path.contains(['\\', ':']) {
                    true => Ok(path.clone()),
                    false => Err(Error::integrity(format!(
                        "the weight file {path:?} is outside the model's folder; do not trust this model.json"
                    ))),
                }
            })
            .collect()
    }
}

/// Returns node and output index of an input string; control inputs (`^node`) have no index.
pub fn producer(input: &str) -> (&str, Option<usize>) {
    if let Some(control) = input.strip_prefix('^') {
        return (control, None);
    }
    match input.rsplit_once(':') {
        Some((node, output)) if !output.is_empty() && output.bytes().all(|byte| byte.is_ascii_digit()) => {
            (node, output.parse().ok())
        }
        _ => (input, Some(0)),
    }
}
