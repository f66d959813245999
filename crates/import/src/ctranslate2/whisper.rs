//! Mapping of Whisper's weights to CTranslate2's variables.

use opendr_engine::{Error, Result, ResultExt};
use opendr_onnx::{Array, Data};

use crate::ctranslate2::file::Ctranslate2File;
use crate::whisper::{WhisperOnnx, WhisperWeights, onnx_from_whisper};

/// Maximum size of a `model.bin`, in bytes: an ONNX file is limited to 2 GiB.
const MAX_BYTES: usize = 1 << 31;

/// Converts the `model.bin` of a Whisper in CTranslate2's format to ONNX. Weights of 16 bits keep their type.
///
/// # Errors
/// `Format` for a damaged file, `Unsupported` for a network other than Whisper, for quantised weights, and for
/// versions of the format other than 4 to 6.
pub fn whisper_from_ctranslate2(model_bin: &[u8]) -> Result<WhisperOnnx> {
    if model_bin.len() > MAX_BYTES {
        return Err(Error::unsupported(format!(
            "{} bytes of weights exceed the limit of {MAX_BYTES}",
            model_bin.len()
        )));
    }
    let file = Ctranslate2File::read(model_bin)?;
    if file.specification != "WhisperSpec" {
        return Err(Error::unsupported(format!(
            "the CTranslate2 model is a {:.80}; only WhisperSpec is supported",
            file.specification
        )));
    }
    onnx_from_whisper(&Weights { file }).context(|| "CTranslate2's Whisper")
}

struct Weights<'a> {
    file: Ctranslate2File<'a>,
}

/// A variable, and one of the equal parts into which its rows are divided.
struct Place {
    variable: String,
    part: usize,
    parts: usize,
}

/// Returns the variable of a weight with one of Hugging Face's names; `None` for one that Whisper does not have.
fn place(name: &str) -> Option<Place> {
    let whole = |variable: String| Some(Place { variable, part: 0, parts: 1 });
    let (side, rest) = name.split_once('.')?;
    let (rest, kind) = rest.rsplit_once('.')?;
    let norm = match kind {
        "weight" => "gamma",
        _ => "beta",
    };
    match rest {
        "conv1" | "conv2" => return whole(format!("{side}/{rest}/{kind}")),
        "embed_positions" => return whole(format!("{side}/position_encodings/encodings")),
        "embed_tokens" => return whole(format!("{side}/embeddings/weight")),
        "layer_norm" => return whole(format!("{side}/layer_norm/{norm}")),
        _ => {}
    }
    let (layer, part) = rest.strip_prefix("layers.")?.split_once('.')?;
    let layer = format!("{side}/layer_{layer}");
    match part {
        "fc1" => return whole(format!("{layer}/ffn/linear_0/{kind}")),
        "fc2" => return whole(format!("{layer}/ffn/linear_1/{kind}")),
        "final_layer_norm" => return whole(format!("{layer}/ffn/layer_norm/{norm}")),
        "self_attn_layer_norm" => return whole(format!("{layer}/self_attention/layer_norm/{norm}")),
        "encoder_attn_layer_norm" => return whole(format!("{layer}/attention/layer_norm/{norm}")),
        _ => {}
    }
    let (linear, part, parts) = match part {
        "self_attn.q_proj" => ("self_attention/linear_0", 0, 3),
        "self_attn.k_proj" => ("self_attention/linear_0", 1, 3),
        "self_attn.v_proj" => ("self_attention/linear_0", 2, 3),
        "self_attn.out_proj" => ("self_attention/linear_1", 0, 1),
        "encoder_attn.q_proj" => ("attention/linear_0", 0, 1),
        "encoder_attn.k_proj" => ("attention/linear_1", 0, 2),
        "encoder_attn.v_proj" => ("attention/linear_1", 1, 2),
        "encoder_attn.out_proj" => ("attention/linear_2", 0, 1),
        _ => return None,
    };
    Some(Place { variable: format!("{layer}/{linear}/{kind}"), part, parts })
}

impl WhisperWeights for Weights<'_> {
    fn has(&self, name: &str) -> bool {
        place(name).is_some_and(|place| self.file.has(&place.variable))
    }

    fn get(&self, name: &str) -> Result<Array> {
        let Place { variable, part, parts } =
            place(name).ok_or_else(|| Error::internal(format!("Whisper has no weight {name:?}")))?;
        let array = self.file.floats(&variable)?;
        if parts == 1 {
            return Ok(array);
        }
        let (rows, rest) = array.dims().split_first().unwrap_or((&0, &[]));
        let dims: Vec<usize> = [rows / parts].iter().chain(rest).copied().collect();
        let floats = array.as_floats().unwrap_or_default();
        let size = floats.len() / parts;
        let own = floats.get(part * size..(part + 1) * size).unwrap_or_default().to_vec();
        Array::new(dims, Data::Float(own)).ok_or_else(|| {
            Error::format(format!(
                "CTranslate2: the rows of {variable:?} are not divisible into {parts} equal parts"
            ))
        })
    }

    fn heads(&self, side: &str) -> Option<usize> {
        let heads = self.file.integer(&format!("{side}/num_heads"))?;
        Some(usize::try_from(heads).unwrap_or_default())
    }

    fn is_half(&self) -> bool {
        self.file.is_half()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_map_to_variables() {
        let at = |name: &str| place(name).map(|place| (place.variable, place.part, place.parts));
        let whole = |variable: &str| Some((variable.to_owned(), 0, 1));
        assert_eq!(at("encoder.conv1.bias"), whole("encoder/conv1/bias"));
        assert_eq!(at("decoder.layer_norm.weight"), whole("decoder/layer_norm/gamma"));
        assert_eq!(
            at("decoder.layers.3.encoder_attn.v_proj.bias"),
            Some(("decoder/layer_3/attention/linear_1/bias".to_owned(), 1, 2))
        );
        assert_eq!(at("decoder.layers.0.other.weight"), None);
    }
}
