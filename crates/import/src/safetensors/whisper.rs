//! Import of a Whisper from Hugging Face's transformers.

use opendr_engine::{Error, Result, ResultExt};
use opendr_onnx::{Array, Data, FloatType};

use crate::safetensors::file::{FloatTensor, SafetensorsFile};
use crate::whisper::{WhisperOnnx, WhisperWeights, onnx_from_whisper};

/// Maximum size of a file, in bytes: an ONNX file is limited to 2 GiB.
const MAX_BYTES: usize = 1 << 31;

/// Converts the `model.safetensors` of a Whisper to ONNX. Weights of 16 bits keep their type.
///
/// # Errors
/// `Format` for a damaged file, `Unsupported` for one that is not a Whisper, is larger than 2 GiB, or is one of
/// several parts.
pub fn whisper_from_safetensors(model: &[u8]) -> Result<WhisperOnnx> {
    if model.len() > MAX_BYTES {
        return Err(Error::unsupported(format!(
            "{} bytes of weights exceed the limit of {MAX_BYTES}",
            model.len()
        )));
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
    /// The weights of `WhisperForConditionalGeneration` have the prefix `model.`, those of `WhisperModel` do not.
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
            Error::format(format!("there is no weight \"model.{name:.80}\"; download the file again"))
        })?;
        let floats = tensor.float_type.decode(tensor.bytes);
        if floats.iter().any(|value| !value.is_finite()) {
            return Err(Error::format(format!("{name:?} contains NaN or infinity; download the file again")));
        }
        let array = Array::new(tensor.dims.to_vec(), Data::Float(floats));
        array.ok_or_else(|| Error::internal(format!("the decoded size of {name:?} does not match its shape")))
    }

    /// The number is only in the configuration file; every Whisper has one head per 64 features.
    fn heads(&self, _: &str) -> Option<usize> {
        None
    }

    fn is_half(&self) -> bool {
        self.file.floats().all(|tensor| matches!(tensor.float_type, FloatType::F16))
    }
}
