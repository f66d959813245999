//! Turns files of other formats into ONNX.

use opendr_engine::{Error, Result};
use opendr_import::{ImportOptions, onnx_from_tfjs, tfjs_weight_files};

use crate::card::Import;

/// Changes whenever the importer's sources do, so that no stale conversion is ever used.
pub(crate) const IMPORTER: &str = env!("OPENDR_IMPORTER");

/// The bytes of the file that is made; `files` are those that it is made of, in its order.
pub(crate) fn imported(import: &Import, files: &[&[u8]]) -> Result<Vec<u8>> {
    let Import::Tfjs { image_size, outputs, .. } = import;
    let Some((json, weights)) = files.split_first() else {
        return Err(Error::format("a TensorFlow.js model without files"));
    };
    let named = tfjs_weight_files(json)?.len();
    if named != weights.len() {
        return Err(Error::format(format!("the model has {named} weight files, the card {}", weights.len())));
    }
    let options = ImportOptions { image_size: *image_size, outputs: outputs.clone() };
    onnx_from_tfjs(json, weights, &options)
}
