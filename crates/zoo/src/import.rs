//! Turns files of other formats into ONNX.

use std::borrow::Cow;

use opendr_engine::{Error, Result};
use opendr_import::{ImportOptions, onnx_from_tfjs, tfjs_weight_files, whisper_from_ctranslate2};

use crate::card::Import;

/// Changes whenever the importer's sources do, so that no stale conversion is ever used.
pub(crate) const IMPORTER: &str = env!("OPENDR_IMPORTER");

/// The container's files: a name and its bytes.
type Files<'a> = Vec<(String, Cow<'a, [u8]>)>;

/// The files that are made; `names` and `files` are those of the card, in its order.
pub(crate) fn imported<'a>(import: &Import, names: &[&str], files: &'a [Vec<u8>]) -> Result<Files<'a>> {
    let Some((first, others)) = files.split_first() else {
        return Err(Error::format("a model without files"));
    };
    match import {
        Import::Tfjs { output, image_size, outputs } => {
            let weights: Vec<&[u8]> = others.iter().map(Vec::as_slice).collect();
            let named = tfjs_weight_files(first)?.len();
            if named != weights.len() {
                let given = weights.len();
                return Err(Error::format(format!("the model has {named} weight files, the card {given}")));
            }
            let options = ImportOptions { image_size: *image_size, outputs: outputs.clone() };
            Ok(vec![(output.clone(), onnx_from_tfjs(first, &weights, &options)?.into())])
        }
        Import::Ctranslate2Whisper => {
            let networks = whisper_from_ctranslate2(first)?;
            let mut made: Files<'_> = vec![
                ("encoder.onnx".to_owned(), networks.encoder.into()),
                ("decoder.onnx".to_owned(), networks.decoder.into()),
            ];
            let copied = names.iter().skip(1).zip(others);
            made.extend(copied.map(|(name, bytes)| ((*name).to_owned(), bytes.into())));
            Ok(made)
        }
    }
}
