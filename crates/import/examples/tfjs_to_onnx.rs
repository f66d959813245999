//! `tfjs_to_onnx model.json out.onnx [HEIGHTxWIDTH]`: converts a TensorFlow.js graph model to ONNX.

use std::path::Path;
use std::process::ExitCode;

use opendr_import::{ImportOptions, onnx_from_tfjs_file};

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let (model, out, size) = match arguments.as_slice() {
        [model, out] => (model, out, None),
        [model, out, size] => (model, out, size.split_once('x')),
        _ => {
            eprintln!("usage: tfjs_to_onnx model.json out.onnx [HEIGHTxWIDTH]");
            return ExitCode::from(2);
        }
    };
    let image_size = size.and_then(|(height, width)| Some((height.parse().ok()?, width.parse().ok()?)));
    let options = ImportOptions { image_size, ..ImportOptions::default() };
    let written =
        onnx_from_tfjs_file(Path::new(model), &options).and_then(|onnx| Ok(std::fs::write(out, onnx)?));
    match written {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}
