//! Turns files of other formats into ONNX.

use std::borrow::Cow;

use opendr_engine::{Error, Result};
use opendr_import::{
    ImportOptions, WhisperOnnx, onnx_from_ncnn, onnx_from_tfjs, onnx_from_tflite, tfjs_weight_files,
    whisper_from_ctranslate2, whisper_from_onnx, whisper_from_safetensors,
};

use crate::card::{Import, ImportedNetwork};

/// Changes whenever the importer's sources do, so that no stale conversion is ever used.
pub(crate) const IMPORTER: &str = env!("OPENDR_IMPORTER");

/// Names and bytes of files.
type Files<'a> = Vec<(&'a str, Cow<'a, [u8]>)>;

/// The files that are made; `files` are those that they are made of, with their names, in the import's order.
pub(crate) fn imported<'a>(import: &'a Import, files: &[(&'a str, &'a [u8])]) -> Result<Files<'a>> {
    let Some(((_, first), others)) = files.split_first() else {
        return Err(Error::format("a model without files"));
    };
    match import {
        Import::Tfjs(network) => {
            let weights: Vec<&[u8]> = others.iter().map(|(_, bytes)| *bytes).collect();
            let named = tfjs_weight_files(first)?.len();
            if named != weights.len() {
                let given = weights.len();
                return Err(Error::format(format!("the model has {named} weight files, the card {given}")));
            }
            Ok(vec![(&network.output, onnx_from_tfjs(first, &weights, &options(network))?.into())])
        }
        Import::Tflite(network) if others.is_empty() => {
            Ok(vec![(&network.output, onnx_from_tflite(first, &options(network))?.into())])
        }
        Import::Tflite(_) => Err(Error::format(format!("a TensorFlow Lite model of {} files", files.len()))),
        Import::Ncnn(network) => match others {
            [(_, weights)] => {
                Ok(vec![(&network.output, onnx_from_ncnn(first, weights, &options(network))?.into())])
            }
            _ => Err(Error::format(format!(
                "an ncnn model of {} files: layers and weights are two",
                files.len()
            ))),
        },
        Import::Ctranslate2Whisper | Import::SafetensorsWhisper => {
            let networks = match import {
                Import::Ctranslate2Whisper => whisper_from_ctranslate2(first)?,
                _ => whisper_from_safetensors(first)?,
            };
            Ok(whisper(networks, others))
        }
        Import::OnnxWhisper => match others {
            [(_, decoder), others @ ..] => Ok(whisper(whisper_from_onnx(first, decoder)?, others)),
            [] => Err(Error::format("a Whisper has an encoder and a decoder; give both files")),
        },
    }
}

/// The networks, and what goes with them as it is.
fn whisper<'a>(networks: WhisperOnnx, others: &[(&'a str, &'a [u8])]) -> Files<'a> {
    let [encoder, decoder] = Import::WHISPER;
    let made = [(encoder, networks.encoder.into()), (decoder, networks.decoder.into())];
    made.into_iter().chain(others.iter().map(|(name, bytes)| (*name, Cow::Borrowed(*bytes)))).collect()
}

fn options(network: &ImportedNetwork) -> ImportOptions {
    ImportOptions { image_size: network.image_size, outputs: network.outputs.clone() }
}
