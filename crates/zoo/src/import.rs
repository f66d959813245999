//! Conversion of model files of other formats to ONNX.

use std::borrow::Cow;

use opendr_engine::{Error, Result};
use opendr_import::{
    ImportOptions, WhisperOnnx, onnx_from_ncnn, onnx_from_tfjs, onnx_from_tflite, tfjs_weight_files,
    whisper_from_ctranslate2, whisper_from_onnx, whisper_from_safetensors,
};

use crate::card::{Import, ImportedNetwork};

/// Version of the importer, which changes with its sources, so that no outdated conversion is used.
pub(crate) const IMPORTER: &str = env!("OPENDR_IMPORTER");

/// Names and bytes of files.
type Files<'a> = Vec<(&'a str, Cow<'a, [u8]>)>;

/// Returns the converted files; `files` are the inputs with their names, in the order of the import.
pub(crate) fn imported<'a>(import: &'a Import, files: &[(&'a str, &'a [u8])]) -> Result<Files<'a>> {
    let Some(((_, first), others)) = files.split_first() else {
        return Err(Error::format("the model has no files"));
    };
    match import {
        Import::Tfjs(network) => {
            let weights: Vec<&[u8]> = others.iter().map(|(_, bytes)| *bytes).collect();
            let named = tfjs_weight_files(first)?.len();
            if named != weights.len() {
                let given = weights.len();
                return Err(Error::format(format!(
                    "the model has {named} weight files, but the card has {given}"
                )));
            }
            Ok(vec![(&network.output, onnx_from_tfjs(first, &weights, &options(network))?.into())])
        }
        Import::Tflite(network) if others.is_empty() => {
            Ok(vec![(&network.output, onnx_from_tflite(first, &options(network))?.into())])
        }
        Import::Tflite(_) => {
            Err(Error::format(format!("a TensorFlow Lite model has one file, not {}", files.len())))
        }
        Import::Ncnn(network) => match others {
            [(_, weights)] => {
                Ok(vec![(&network.output, onnx_from_ncnn(first, weights, &options(network))?.into())])
            }
            _ => Err(Error::format(format!(
                "an ncnn model has two files (.param and weights), not {}",
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
            [] => Err(Error::format("a Whisper model has an encoder and a decoder; give both files")),
        },
    }
}

/// Returns the networks and the files that are copied unchanged.
fn whisper<'a>(networks: WhisperOnnx, others: &[(&'a str, &'a [u8])]) -> Files<'a> {
    let [encoder, decoder] = Import::WHISPER;
    let made = [(encoder, networks.encoder.into()), (decoder, networks.decoder.into())];
    made.into_iter().chain(others.iter().map(|(name, bytes)| (*name, Cow::Borrowed(*bytes)))).collect()
}

fn options(network: &ImportedNetwork) -> ImportOptions {
    ImportOptions { image_size: network.image_size, outputs: network.outputs.clone() }
}
