//! A Whisper that PyTorch exported to ONNX, as Hugging Face's Optimum writes it.
//!
//! Networks of other programs pass around their memory in ways of their own; of these files only the weights are taken, by the
//! names that PyTorch's exporter gives weights and, where it transposed them for a product, nodes.

use std::collections::HashMap;

use opendr_engine::{Error, Result, ResultExt};
use opendr_onnx::proto::{DataType, GraphProto, NodeProto, TensorProto};
use opendr_onnx::{Array, Data, FloatType, model_from_bytes};

use super::sizes::PLACES;
use super::{WhisperOnnx, WhisperWeights, onnx_from_whisper};

/// What every such encoder has, and no encoder of ours.
const MARK: &[u8] = b"/self_attn/q_proj/MatMul";

/// Whether a file is, by a name in it, half of a Whisper that PyTorch exported.
pub fn is_exported_whisper(model: &[u8]) -> bool {
    model.windows(MARK.len()).any(|bytes| bytes == MARK)
}

/// Turns the `encoder_model.onnx` and `decoder_model.onnx` of a Whisper that PyTorch exported, e.g. by Hugging Face's Optimum, into
/// the networks that the learner runs. A `decoder_model_merged.onnx` will do, a quantised one will not. Weights of 16 bits
/// stay so.
///
/// # Errors
/// `Format` for damaged files, `Unsupported` for those that have not the weights of a Whisper.
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
    /// Which tensor a name stands for; some stand for the same.
    names: HashMap<String, usize>,
    /// The module of each product with a weight, e.g. `/layers.0/fc1`, and what its input is multiplied with.
    products: Vec<(String, usize)>,
}

impl Side {
    fn read(bytes: &[u8]) -> Result<Self> {
        let mut side = Self { tensors: Vec::new(), names: HashMap::new(), products: Vec::new() };
        let mut graphs: Vec<GraphProto> = model_from_bytes(bytes)?.graph.into_iter().collect();
        let mut at = 0;
        // A merged decoder has its two ways in graphs within the graph.
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

    /// The tensor called `name`, perhaps within other modules.
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

    /// What the module called `name` multiplies with: the transposed weight of a dense layer.
    fn factor(&self, name: &str) -> Option<&TensorProto> {
        // Lists of modules keep their dot: `layers.0`.
        let path = format!("/{}", name.replace('.', "/").replace("layers/", "layers."));
        let (_, at) = self.products.iter().find(|(module, _)| module.ends_with(&path))?;
        self.tensors.get(*at)
    }

    /// The encoder's positions, which the exporter adds under a name of its own.
    fn places(&self) -> Option<&TensorProto> {
        let is_places = |tensor: &&TensorProto| matches!(tensor.dims[..], [rows, _] if rows == PLACES as i64);
        self.tensors.iter().find(is_places)
    }
}

impl Weights {
    /// The tensor of a weight, and whether it is transposed.
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
                "no weight \"{name:.80}\", so it is no Whisper as PyTorch exports it, or a quantised one; give encoder_model.onnx, \
                 then decoder_model.onnx, or the model.safetensors that they were made of"
            ))
        })?;
        let array = match DataType::try_from(tensor.data_type) {
            Ok(DataType::Float16) => {
                let dims: Option<Vec<usize>> =
                    tensor.dims.iter().map(|dim| usize::try_from(*dim).ok()).collect();
                dims.and_then(|dims| Array::new(dims, Data::Float(FloatType::F16.numbers(&tensor.raw_data))))
            }
            _ => Array::from_tensor(tensor),
        };
        let array = array.ok_or_else(|| {
            Error::unsupported(format!(
                "the weight \"{name:.80}\" does not lie in the file, or not as floats; export in one file, not quantised"
            ))
        })?;
        let floats = array.as_floats().filter(|floats| floats.iter().all(|value| value.is_finite()));
        let Some(floats) = floats else {
            return Err(Error::format(format!("{name:?} holds what is no number; get the file anew")));
        };
        match array.dims() {
            &[rows, columns] if is_transposed => {
                let turned = (0..columns).flat_map(|column| (0..rows).map(move |row| row * columns + column));
                let turned = turned.map(|at| floats[at]).collect();
                let array = Array::new(vec![columns, rows], Data::Float(turned));
                array.ok_or_else(|| Error::internal(format!("{name:?} lost its size when it was turned")))
            }
            _ => Ok(array),
        }
    }

    /// Not in the file; all Whispers have one for 64 features.
    fn heads(&self, _: &str) -> Option<usize> {
        None
    }

    fn is_half(&self) -> bool {
        let conv = self.encoder.named("conv1.weight");
        conv.is_some_and(|tensor| tensor.data_type == DataType::Float16 as i32)
    }
}
