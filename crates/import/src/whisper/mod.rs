//! The networks of Whisper in ONNX.
//!
//! Radford et al., Robust Speech Recognition via Large-Scale Weak Supervision, 2022. `layers` has the shared layers,
//! `encoder` and `decoder` build the two networks.

mod decoder;
mod encoder;
mod layers;
mod onnx;
mod sizes;
mod weights;

use opendr_engine::Result;
use opendr_onnx::proto::GraphProto;
use opendr_onnx::{bytes_from_model, model_from_graph, passes};

pub use onnx::{is_exported_whisper, whisper_from_onnx};
use sizes::Sizes;
pub use weights::WhisperWeights;

/// The two networks of a Whisper as ONNX files (opset 17), for ONNX Runtime and the built-in runtime.
///
/// D is the width, H = D / 64 the number of heads, L the number of the decoder's layers, V the number of tokens.
#[derive(Debug, Clone)]
pub struct WhisperOnnx {
    /// Input: `mel` `[1, 80 or 128, 3000]`. Outputs: keys and values for cross-attention, `cross_key_0`
    /// `[H, 64, 1500]` and `cross_value_0` `[H, 1500, 64]`, and so on for each of the L layers.
    pub encoder: Vec<u8>,
    /// Inputs, for T tokens after P cached ones: `tokens` `[T]` and `positions` `[T]` (both `int64`), `mask`
    /// `[T, P + T]` that is added to the attention scores, for each layer `key_0` and `value_0` `[P, D]`, then for
    /// each layer `cross_key_0` and `cross_value_0`. Outputs: `logits` `[1, V]` of the next token, and for each layer
    /// `new_key_0` and `new_value_0` `[T, D]`, to be cached. P is at least 1; masked positions have no effect.
    pub decoder: Vec<u8>,
}

/// Builds the networks from a source of weights.
///
/// # Errors
/// `Format` for missing or inconsistent weights, and the errors of `weights`.
pub fn onnx_from_whisper(weights: &dyn WhisperWeights) -> Result<WhisperOnnx> {
    let sizes = Sizes::of(weights)?;
    let encoder = bytes(encoder::graph(weights, &sizes)?, weights);
    Ok(WhisperOnnx { encoder, decoder: bytes(decoder::graph(weights, &sizes)?, weights) })
}

fn bytes(mut graph: GraphProto, weights: &dyn WhisperWeights) -> Vec<u8> {
    passes::remove_identities(&mut graph);
    if weights.is_half() {
        passes::weights_to_fp16(&mut graph);
    }
    bytes_from_model(&model_from_graph(graph))
}
