//! What a network states about itself: inputs, outputs, metadata, and the operators that compute its outputs.

use std::collections::{HashMap, HashSet};

use opendr_engine::model::Model;
use opendr_engine::target::Classes;
use opendr_engine::{Device, Error, Result};
use opendr_inference::{ElementType, Session, TensorInfo, declared_tensors};
use opendr_onnx::proto::{GraphProto, NodeProto};
use opendr_onnx::{bytes_from_model, model_from_bytes, passes};

use super::class_names;

/// Operators whose further inputs are shapes or indices, which are not followed.
const SHAPED: [&str; 9] =
    ["Reshape", "Expand", "Slice", "Gather", "Unsqueeze", "Squeeze", "Resize", "Tile", "Split"];
/// Operators of layers with weights, at which an output's computation is followed no further.
const LAYERS: [&str; 4] = ["Conv", "ConvTranspose", "Gemm", "MatMul"];

/// Minimum side of the patches of a vision transformer, in pixels; kernels that small belong to other networks.
const MIN_PATCH: usize = 8;

/// Facts about a network.
pub struct Facts {
    /// Inputs.
    pub inputs: Vec<TensorInfo>,
    /// Outputs.
    pub outputs: Vec<TensorInfo>,
    metadata: HashMap<String, String>,
    operators: HashSet<String>,
    /// Dimensions of the weights, by name.
    weights: HashMap<String, Vec<i64>>,
    graph: GraphProto,
}

impl Facts {
    /// Opens the network of a model and reads its facts.
    ///
    /// # Errors
    /// Those of [`Model::onnx`] and [`Session::open`].
    pub fn open(model: &Model, device: Device) -> Result<(Session, Self)> {
        Self::open_network(&model.onnx()?, device)
    }

    /// Opens a network of a model of several and reads its facts.
    ///
    /// # Errors
    /// Those of [`Session::open`].
    pub fn open_network(onnx: &[u8], device: Device) -> Result<(Session, Self)> {
        let session = Session::open(onnx, device)?;
        let facts = Self::new(onnx, session.inputs().to_vec(), session.outputs().to_vec())?;
        Ok((session, facts))
    }

    /// Reads the facts that an ONNX file declares.
    ///
    /// # Errors
    /// `Format` when the bytes are not an ONNX model.
    pub fn declared(onnx: &[u8]) -> Result<Self> {
        let [inputs, outputs] = declared_tensors(onnx)?;
        Self::new(onnx, inputs, outputs)
    }

    fn new(onnx: &[u8], inputs: Vec<TensorInfo>, outputs: Vec<TensorInfo>) -> Result<Self> {
        let model = model_from_bytes(onnx)?;
        let mut graph = model.graph.unwrap_or_default();
        let weights = graph.initializer.drain(..).map(|tensor| (tensor.name, tensor.dims)).collect();
        Ok(Self {
            inputs,
            outputs,
            metadata: model.metadata_props.into_iter().map(|entry| (entry.key, entry.value)).collect(),
            operators: graph.node.iter().map(|node| node.op_type.clone()).collect(),
            weights,
            graph,
        })
    }

    /// Returns an entry of the metadata; empty if there is none.
    pub fn metadata(&self, key: &str) -> &str {
        self.metadata.get(key).map_or("", String::as_str)
    }

    /// Returns the class names of the model, else those in the metadata of Ultralytics; empty if there are none.
    pub fn classes(&self, model: &Model) -> Classes {
        match model.classes() {
            given if given.is_empty() => {
                Classes::from(class_names(self.metadata("names")).unwrap_or_default())
            }
            given => given.clone(),
        }
    }

    /// Returns whether the metadata are those of Ultralytics.
    pub fn is_of_ultralytics(&self) -> bool {
        ["stride", "names"].iter().all(|key| !self.metadata(key).is_empty())
    }

    /// Returns whether an export of Ultralytics ends in detections, after suppression.
    pub fn has_suppressed(&self) -> bool {
        self.metadata("end2end") == "True"
            || self.metadata("args").contains("'nms': True")
            || self.has_operator("NonMaxSuppression")
    }

    /// Returns whether the network has an operator.
    pub fn has_operator(&self, name: &str) -> bool {
        self.operators.contains(name)
    }

    /// Returns whether the name of a tensor of weights contains `part`. Exporters of PyTorch name it by the module that it belongs to.
    pub fn has_weights_of(&self, part: &str) -> bool {
        self.weights.keys().any(|name| name.contains(part))
    }

    /// Returns the dimensions of the tensor of weights whose name contains `part`; `None` if several do, with other dimensions.
    pub fn weight_dims(&self, part: &str) -> Option<&[i64]> {
        let mut found = self.weights.iter().filter(|(name, _)| name.contains(part)).map(|(_, dims)| dims);
        let dims = found.next()?;
        found.all(|other| other == dims).then_some(dims)
    }

    /// Returns whether an operator named `kind` reads an input of the network.
    pub fn reads_input_by(&self, kind: &str) -> bool {
        let is_input = |name: &String| self.inputs.iter().any(|input| input.name == *name);
        self.graph.node.iter().any(|node| node.op_type == kind && node.input.iter().any(is_input))
    }

    /// Returns the side of the patches of a vision transformer: that of a convolution whose kernel covers each pixel once.
    pub fn patch_side(&self) -> Option<usize> {
        self.graph.node.iter().filter(|node| node.op_type == "Conv").find_map(|node| {
            let strides = node.attribute.iter().find(|attribute| attribute.name == "strides")?;
            let kernel = self.weights.get(node.input.get(1)?)?.get(2..)?;
            let [height, width] = *kernel else { return None };
            let covers = strides.ints == kernel && height == width;
            usize::try_from(height).ok().filter(|side| covers && *side >= MIN_PATCH)
        })
    }

    /// Returns the index of the output whose name contains `part`.
    pub fn output_named(&self, part: &str) -> Option<usize> {
        self.outputs.iter().position(|output| output.name.contains(part))
    }

    /// Returns the only output for which `is` holds.
    pub fn only_output(&self, is: impl Fn(&TensorInfo) -> bool) -> Option<usize> {
        let mut found = (0..).zip(&self.outputs).filter(|(_, output)| is(output)).map(|(index, _)| index);
        found.next().filter(|_| found.next().is_none())
    }

    /// Returns the index of the output of mask prototypes, `[1, channels, height, width]`, and their number.
    pub fn prototypes(&self) -> Option<(usize, usize)> {
        let output = self.only_output(|output| {
            output.element_type == ElementType::F32 && matches!(output.dims[..], [_, Some(_), _, _])
        })?;
        self.outputs[output].dims[1].map(|channels| (output, channels))
    }

    /// Returns the operators between an output and the last layers with weights.
    pub fn tail(&self, output: usize) -> HashSet<&str> {
        let makers: HashMap<&str, &NodeProto> = self
            .graph
            .node
            .iter()
            .flat_map(|node| node.output.iter().map(move |name| (name.as_str(), node)))
            .collect();
        let mut names: Vec<&str> =
            self.outputs.get(output).map(|output| output.name.as_str()).into_iter().collect();
        let (mut seen, mut found) = (HashSet::new(), HashSet::new());
        while let Some(name) = names.pop() {
            let Some(node) = makers.get(name).filter(|_| seen.insert(name)) else { continue };
            let kind = node.op_type.as_str();
            if LAYERS.contains(&kind) {
                continue;
            }
            found.insert(kind);
            let followed = if SHAPED.contains(&kind) { 1 } else { node.input.len() };
            names.extend(node.input.iter().take(followed).map(String::as_str));
        }
        found
    }

    /// Returns the error for a network whose layout is neither recognised nor given; `missing` has the names of the parameters to set.
    pub fn unsettled(&self, missing: &[&str]) -> Error {
        Error::unsupported(format!(
            "the network does not state all of its layout; set {} ({})",
            missing.join(", "),
            self.describe()
        ))
    }

    /// Returns inputs and outputs as one text for messages.
    pub fn describe(&self) -> String {
        let list = |infos: &[TensorInfo]| {
            let texts: Vec<String> = infos.iter().take(12).map(ToString::to_string).collect();
            texts.join(", ")
        };
        format!("inputs {}; outputs {}", list(&self.inputs), list(&self.outputs))
    }
}

/// Opens a network of which only the outputs with these names are computed.
///
/// # Errors
/// `Format` when the bytes are not an ONNX model; those of [`Session::open`].
pub fn open_outputs(onnx: &[u8], names: &[&str], device: Device) -> Result<Session> {
    let mut model = model_from_bytes(onnx)?;
    if let Some(graph) = &mut model.graph {
        passes::reduce_to_outputs(graph, &[], names);
    }
    Session::open(&bytes_from_model(&model), device)
}

/// Returns the last two dimensions of a tensor of floats with at least `rank` dimensions.
pub fn last_two(info: &TensorInfo, rank: usize) -> Option<[Option<usize>; 2]> {
    match info.dims[..] {
        [.., first, second] if info.element_type == ElementType::F32 && info.dims.len() >= rank => {
            Some([first, second])
        }
        _ => None,
    }
}

/// Returns whether a tensor has integer elements.
pub fn is_integer(info: &TensorInfo) -> bool {
    matches!(info.element_type, ElementType::I32 | ElementType::I64)
}
