//! `ncnn_to_onnx model.param model.bin out.onnx`: converts an ncnn model to ONNX.

use std::path::Path;
use std::process::ExitCode;

use opendr_import::{ImportOptions, onnx_from_ncnn_files};

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [param, bin, out] = arguments.as_slice() else {
        eprintln!("usage: ncnn_to_onnx model.param model.bin out.onnx");
        return ExitCode::from(2);
    };
    let written = onnx_from_ncnn_files(Path::new(param), Path::new(bin), &ImportOptions::default())
        .and_then(|onnx| Ok(std::fs::write(out, onnx)?));
    match written {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}
