//! The networks of Whisper as ONNX.
//!
//! Radford et al., Robust Speech Recognition via Large-Scale Weak Supervision, 2022. `layers` writes what both halves are
//! made of, `encoder` and `decoder` the halves.

mod decoder;
mod encoder;
mod layers;
mod onnx;
mod sizes;

use opendr_engine::Result;
use opendr_onnx::proto::GraphProto;
use opendr_onnx::{Array, bytes_from_model, model_from_graph, passes};

pub use onnx::{is_exported_whisper, whisper_from_onnx};
use sizes::Sizes;

/// Features of an attention head, in Whispers of every size.
const HEAD: usize = 64;

/// Where the weights of a Whisper come from, in the layout of PyTorch and with Hugging Face's names without the leading
/// `model.`, e.g. `decoder.layers.0.self_attn.q_proj.weight`. One that takes a new file is a table of names.
pub trait WhisperWeights {
    /// Whether there is a weight of that name.
    fn has(&self, name: &str) -> bool;

    /// The weight of that name.
    ///
    /// # Errors
    /// `Format` when there is none, or it cannot be read.
    fn get(&self, name: &str) -> Result<Array>;

    /// Attention heads of `"encoder"` or `"decoder"`, where the file says.
    fn heads(&self, side: &str) -> Option<usize>;

    /// Whether the weights have 16 bits, so that storing them so loses nothing.
    fn is_half(&self) -> bool;
}

/// The two networks of a Whisper, ONNX files (opset 17) that run in ONNX Runtime and in the built-in runtime.
///
/// D is the width, H = D / 64 the number of heads, L the number of the decoder's layers, V the number of tokens.
#[derive(Debug, Clone)]
pub struct WhisperOnnx {
    /// `mel` `[1, 80 or 128, 3000]` to what the decoder attends to: `cross_key_0` `[H, 64, 1500]`, `cross_value_0`
    /// `[H, 1500, 64]`, and so on for each of its L layers.
    pub encoder: Vec<u8>,
    /// T tokens after P that are remembered: `tokens` `[T]`, `positions` `[T]` (both `int64`), `mask` `[T, P + T]` that is
    /// added to the scores of attention, for each layer `key_0` and `value_0` `[P, D]`, then for each layer `cross_key_0`
    /// and `cross_value_0`; to `logits` `[1, V]` of what follows the last token, and for each layer `new_key_0` and
    /// `new_value_0` `[T, D]`, to be remembered. P is at least 1: what is masked counts for nothing.
    pub decoder: Vec<u8>,
}

/// Builds the networks around weights from anywhere.
///
/// # Errors
/// `Format` for weights that are missing or do not fit each other, and whatever `weights` return.
pub fn onnx_from_whisper(weights: &dyn WhisperWeights) -> Result<WhisperOnnx> {
    let sizes = Sizes::of(weights)?;
    let encoder = bytes(encoder::graph(weights, &sizes)?, weights);
    Ok(WhisperOnnx { encoder, decoder: bytes(decoder::graph(weights, &sizes)?, weights) })
}

fn bytes(mut graph: GraphProto, weights: &dyn WhisperWeights) -> Vec<u8> {
    passes::remove_identities(&mut graph);
    if weights.is_half() {
        passes::halve_weights(&mut graph);
    }
    bytes_from_model(&model_from_graph(graph))
}
