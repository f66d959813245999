//! Turns files of other formats into ONNX.

use opendr_engine::{Error, Result};
use opendr_import::{ImportOptions, onnx_from_tfjs, onnx_from_tflite, tfjs_weight_files};

use crate::card::Import;

/// Changes whenever the importer's sources do, so that no stale conversion is ever used.
pub(crate) const IMPORTER: &str = env!("OPENDR_IMPORTER");

/// The name of the file that is made and its bytes; `files` are those of the card, in its order.
pub(crate) fn imported(import: &Import, files: &[Vec<u8>]) -> Result<(String, Vec<u8>)> {
    let (Import::Tfjs { output, image_size, outputs } | Import::Tflite { output, image_size, outputs }) =
        import;
    let options = ImportOptions { image_size: *image_size, outputs: outputs.clone() };
    let onnx = match import {
        Import::Tfjs { .. } => from_tfjs(files, &options),
        Import::Tflite { .. } => match files {
            [model] => onnx_from_tflite(model, &options),
            other => Err(Error::format(format!("a TensorFlow Lite model of {} files", other.len()))),
        },
    };
    Ok((output.clone(), onnx?))
}

fn from_tfjs(files: &[Vec<u8>], options: &ImportOptions) -> Result<Vec<u8>> {
    let Some((json, weights)) = files.split_first() else {
        return Err(Error::format("a TensorFlow.js model without files"));
    };
    let weights: Vec<&[u8]> = weights.iter().map(Vec::as_slice).collect();
    let named = tfjs_weight_files(json)?.len();
    if named != weights.len() {
        return Err(Error::format(format!("the model has {named} weight files, the card {}", weights.len())));
    }
    onnx_from_tfjs(json, &weights, options)
}
