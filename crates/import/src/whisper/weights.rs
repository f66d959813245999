//! Sources of Whisper's weights.

use opendr_engine::Result;
use opendr_onnx::Array;

/// A source of Whisper's weights, in the layout of PyTorch and with Hugging Face's names without the prefix `model.`,
/// e.g. `decoder.layers.0.self_attn.q_proj.weight`. Implementations map these names to a file format.
pub trait WhisperWeights {
    /// Returns whether there is a weight of that name.
    fn has(&self, name: &str) -> bool;

    /// Returns the weight of that name.
    ///
    /// # Errors
    /// `Format` when it is missing or cannot be read.
    fn get(&self, name: &str) -> Result<Array>;

    /// Returns the number of attention heads of `"encoder"` or `"decoder"`, where the file states it.
    fn heads(&self, side: &str) -> Option<usize>;

    /// Returns whether the weights have 16 bits, so that storing them in 16 bits is lossless.
    fn is_half(&self) -> bool;
}
