//! `whisper_to_onnx model.bin|model.safetensors|ENCODER.onnx [DECODER.onnx] FOLDER`: converts a Whisper from
//! CTranslate2, transformers or a PyTorch export to `encoder.onnx` and `decoder.onnx`.

use std::process::ExitCode;

use opendr_import::{SafetensorsFile, whisper_from_ctranslate2, whisper_from_onnx, whisper_from_safetensors};

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [model, decoder @ .., folder] = arguments.as_slice() else {
        eprintln!("usage: whisper_to_onnx model.bin|model.safetensors|ENCODER.onnx [DECODER.onnx] FOLDER");
        return ExitCode::from(2);
    };
    let folder = std::path::Path::new(folder);
    let written = std::fs::read(model).map_err(Into::into).and_then(|model| {
        let networks = match decoder {
            [decoder] => whisper_from_onnx(&model, &std::fs::read(decoder)?)?,
            _ if SafetensorsFile::is_start(&model) => whisper_from_safetensors(&model)?,
            _ => whisper_from_ctranslate2(&model)?,
        };
        std::fs::write(folder.join("encoder.onnx"), networks.encoder)?;
        std::fs::write(folder.join("decoder.onnx"), networks.decoder)?;
        Ok(())
    });
    match written {
        Ok(()) => ExitCode::SUCCESS,
        Err::<_, opendr_engine::Error>(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}
