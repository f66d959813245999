//! `tflite_to_onnx model.tflite out.onnx`: converts a TensorFlow Lite model to ONNX.

use std::path::Path;
use std::process::ExitCode;

use opendr_import::{ImportOptions, onnx_from_tflite_file};

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [model, out] = arguments.as_slice() else {
        eprintln!("usage: tflite_to_onnx model.tflite out.onnx");
        return ExitCode::from(2);
    };
    let written = onnx_from_tflite_file(Path::new(model), &ImportOptions::default())
        .and_then(|onnx| Ok(std::fs::write(out, onnx)?));
    match written {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}
