//! Import of a Whisper that PyTorch exported to ONNX, in the form of Hugging Face's Optimum.
//!
//! Exporters differ in how a network passes its cache, so only the weights of these files are used, found by the
//! names that PyTorch's exporter gives weights and, where it transposed them for a product, nodes.

use std::collections::HashMap;

use opendr_engine::{Error, Result, ResultExt};
use opendr_onnx::proto::{DataType, GraphProto, NodeProto, TensorProto};
use opendr_onnx::{Array, Data, FloatType, model_from_bytes};

use super::sizes::PLACES;
use super::{WhisperOnnx, WhisperWeights, onnx_from_whisper};

/// A name that every exported encoder contains, and no encoder built here. Networks of images with attention have it too.
const MARK: &[u8] = b"/self_attn/q_proj/MatMul";

/// Returns whether a file is one of the networks of a Whisper that PyTorch exported, by a name in it and because it has no convolution of
/// images.
pub fn is_exported_whisper(model: &[u8]) -> bool {
    model.windows(MARK.len()).any(|bytes| bytes == MARK) && !has_image_convolution(model)
}

fn has_image_convolution(model: &[u8]) -> bool {
    let is_of_images = |node: &NodeProto| {
        let kernel = node.attribute.iter().find(|attribute| attribute.name == "kernel_shape");
        ["Conv", "ConvTranspose"].contains(&node.op_type.as_str())
            && kernel.is_some_and(|kernel| kernel.ints.len() == 2)
    };
    let graph = model_from_bytes(model).ok().and_then(|model| model.graph);
    graph.is_some_and(|graph| graph.node.iter().any(is_of_images))
}

/// Converts the `encoder_model.onnx` and `decoder_model.onnx` of a Whisper that PyTorch exported, e.g. with Hugging
/// Face's Optimum, to the networks of [`WhisperOnnx`]. A `decoder_model_merged.onnx` is supported, a quantised one is
/// not. Weights of 16 bits keep their type.
///
/// # Errors
/// `Format` for damaged files, `Unsupported` for those without Whisper's weights.
pub fn whisper_from_onnx(encoder: &[u8], decoder: &[u8]) -> Result<WhisperOnnx> {
    let [encoder, decoder] = [("the encoder", encoder), ("the decoder", decoder)]
        .map(|(what, bytes)| Side::read(bytes).context(|| what.to_owned()));
    let weights = Weights { encoder: encoder?, decoder: decoder? };
    onnx_from_whisper(&weights).context(|| "ONNX")
}

struct Weights {
    encoder: Side,
    decoder: Side,
}

/// The weights of a file.
struct Side {
    tensors: Vec<TensorProto>,
    /// Tensor index by name; several names may share a tensor.
    names: HashMap<String, usize>,
    /// The module of each product with a weight, e.g. `/layers.0/fc1`, and the index of the weight.
    products: Vec<(String, usize)>,
}

impl Side {
    fn read(bytes: &[u8]) -> Result<Self> {
        let mut side = Self { tensors: Vec::new(), names: HashMap::new(), products: Vec::new() };
        let mut graphs: Vec<GraphProto> = model_from_bytes(bytes)?.graph.into_iter().collect();
        let mut at = 0;
        // A merged decoder has its two branches in subgraphs.
        while let Some(graph) = graphs.get_mut(at) {
            let (initializers, mut nodes) =
                (std::mem::take(&mut graph.initializer), std::mem::take(&mut graph.node));
            for tensor in initializers {
                side.add(tensor.name.clone(), tensor);
            }
            for node in &mut nodes {
                for attribute in &mut node.attribute {
                    graphs.extend(attribute.g.take());
                    if let ("Constant", Some(tensor), [output]) =
                        (node.op_type.as_str(), attribute.t.take(), &node.output[..])
                    {
                        side.add(output.clone(), tensor);
                    }
                }
            }
            nodes.iter().for_each(|node| side.note(node));
            at += 1;
        }
        Ok(side)
    }

    fn add(&mut self, name: String, tensor: TensorProto) {
        self.names.insert(name, self.tensors.len());
        self.tensors.push(tensor);
    }

    fn note(&mut self, node: &NodeProto) {
        match (node.op_type.as_str(), &node.input[..], &node.output[..]) {
            ("Identity", [input], [output]) => {
                if let Some(tensor) = self.names.get(input) {
                    self.names.insert(output.clone(), *tensor);
                }
            }
            ("MatMul", [_, weight], _) => {
                if let (Some(tensor), Some((module, _))) =
                    (self.names.get(weight), node.name.rsplit_once('/'))
                {
                    self.products.push((format!("/{}", module.trim_start_matches('/')), *tensor));
                }
            }
            _ => {}
        }
    }

    /// Returns the tensor called `name`, also within other modules.
    fn named(&self, name: &str) -> Option<&TensorProto> {
        let is_meant = |other: &str| {
            other.strip_suffix(name).is_some_and(|before| before.is_empty() || before.ends_with('.'))
        };
        let at = self.names.get(name).or_else(|| {
            self.names
                .iter()
                .filter(|(other, _)| is_meant(other))
                .min_by_key(|(other, _)| *other)
                .map(|(_, at)| at)
        })?;
        self.tensors.get(*at)
    }

    /// Returns the factor of the module called `name`: the transposed weight of a dense layer.
    fn factor(&self, name: &str) -> Option<&TensorProto> {
        // Lists of modules keep their dot: `layers.0`.
        let path = format!("/{}", name.replace('.', "/").replace("layers/", "layers."));
        let (_, at) = self.products.iter().find(|(module, _)| module.ends_with(&path))?;
        self.tensors.get(*at)
    }

    /// Returns the encoder's position encodings, which the exporter stores under a name of its own.
    fn places(&self) -> Option<&TensorProto> {
        let is_places = |tensor: &&TensorProto| matches!(tensor.dims[..], [rows, _] if rows == PLACES as i64);
        self.tensors.iter().find(is_places)
    }
}

impl Weights {
    /// Returns the tensor of a weight, and whether it is transposed.
    fn find(&self, name: &str) -> Option<(&TensorProto, bool)> {
        let (side, rest) = name.split_once('.')?;
        let side = if side == "encoder" { &self.encoder } else { &self.decoder };
        let named = || side.named(rest).map(|tensor| (tensor, false));
        let factor = || side.factor(rest.strip_suffix(".weight")?).map(|tensor| (tensor, true));
        let places = || {
            let tensor = side.places().filter(|_| name == "encoder.embed_positions.weight")?;
            Some((tensor, false))
        };
        named().or_else(factor).or_else(places)
    }
}

impl WhisperWeights for Weights {
    fn has(&self, name: &str) -> bool {
        self.find(name).is_some()
    }

    fn get(&self, name: &str) -> Result<Array> {
        let (tensor, is_transposed) = self.find(name).ok_or_else(|| {
            Error::unsupported(format!(
                "the weight \"{name:.80}\" is missing: not a Whisper exported by PyTorch, or a quantised one; pass encoder_model.onnx, \
                 then decoder_model.onnx, or the original model.safetensors"
            ))
        })?;
        let array = match DataType::try_from(tensor.data_type) {
            Ok(DataType::Float16) => {
                let dims: Option<Vec<usize>> =
                    tensor.dims.iter().map(|dim| usize::try_from(*dim).ok()).collect();
                dims.and_then(|dims| Array::new(dims, Data::Float(FloatType::F16.decode(&tensor.raw_data))))
            }
            _ => Array::from_tensor(tensor),
        };
        let array = array.ok_or_else(|| {
            Error::unsupported(format!(
                "the weight \"{name:.80}\" is not in the file, or not stored as floats; export to one file, not quantised"
            ))
        })?;
        let floats = array.as_floats().filter(|floats| floats.iter().all(|value| value.is_finite()));
        let Some(floats) = floats else {
            return Err(Error::format(format!("{name:?} contains NaN or infinity; download the file again")));
        };
        match array.dims() {
            &[rows, columns] if is_transposed => {
                let turned = (0..columns).flat_map(|column| (0..rows).map(move |row| row * columns + column));
                let turned = turned.map(|at| floats[at]).collect();
                let array = Array::new(vec![columns, rows], Data::Float(turned));
                array.ok_or_else(|| {
                    Error::internal(format!("the size of {name:?} changed when it was transposed"))
                })
            }
            _ => Ok(array),
        }
    }

    /// The number is not in the file; every Whisper has one head per 64 features.
    fn heads(&self, _: &str) -> Option<usize> {
        None
    }

    fn is_half(&self) -> bool {
        let conv = self.encoder.named("conv1.weight");
        conv.is_some_and(|tensor| tensor.data_type == DataType::Float16 as i32)
    }
}
