//! A Whisper that Hugging Face's transformers saved.

use opendr_engine::{Error, Result, ResultExt};
use opendr_onnx::{Array, Data, FloatType};

use crate::safetensors::file::{FloatTensor, SafetensorsFile};
use crate::whisper::{WhisperOnnx, WhisperWeights, onnx_from_whisper};

/// The most bytes of a file: an ONNX file holds no more than 2 GiB.
const MAX_BYTES: usize = 1 << 31;

/// Turns the `model.safetensors` of a Whisper into ONNX. Weights of 16 bits stay so.
///
/// # Errors
/// `Format` for a damaged file, `Unsupported` for one that is no Whisper, is larger than 2 GiB, or one of several parts.
pub fn whisper_from_safetensors(model: &[u8]) -> Result<WhisperOnnx> {
    if model.len() > MAX_BYTES {
        return Err(Error::unsupported(format!("{} bytes of weights; at most {MAX_BYTES}", model.len())));
    }
    let weights = Weights { file: SafetensorsFile::read(model)? };
    if !weights.has("encoder.conv1.weight") || !weights.has("decoder.embed_tokens.weight") {
        return Err(Error::unsupported(
            "safetensors: no model.encoder.conv1.weight and model.decoder.embed_tokens.weight, so it is no Whisper, or one in \
             several files; save it with max_shard_size=\"2GB\"",
        ));
    }
    onnx_from_whisper(&weights).context(|| "safetensors")
}

struct Weights<'a> {
    file: SafetensorsFile<'a>,
}

impl Weights<'_> {
    /// `WhisperForConditionalGeneration` has its weights under `model.`, `WhisperModel` has not.
    fn tensor(&self, name: &str) -> Option<FloatTensor<'_>> {
        self.file.float(&format!("model.{name}")).or_else(|| self.file.float(name))
    }
}

impl WhisperWeights for Weights<'_> {
    fn has(&self, name: &str) -> bool {
        self.tensor(name).is_some()
    }

    fn get(&self, name: &str) -> Result<Array> {
        let tensor = self.tensor(name).ok_or_else(|| {
            Error::format(format!("there is no weight \"model.{name:.80}\"; get the file anew"))
        })?;
        let floats = tensor.float_type.numbers(tensor.bytes);
        if floats.iter().any(|value| !value.is_finite()) {
            return Err(Error::format(format!("{name:?} holds what is no number; get the file anew")));
        }
        let array = Array::new(tensor.dims.to_vec(), Data::Float(floats));
        array.ok_or_else(|| Error::internal(format!("{name:?} was read to another size than its shape")))
    }

    /// In the configuration beside the file, where all Whispers have one for 64 features.
    fn heads(&self, _: &str) -> Option<usize> {
        None
    }

    fn is_half(&self) -> bool {
        self.file.floats().all(|tensor| matches!(tensor.float_type, FloatType::F16))
    }
}
