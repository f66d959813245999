//! Import of a user's model files, whose format is detected from their content.

use std::path::{Path, PathBuf};

use opendr_engine::model::{Manifest, Model, ModelWriter};
use opendr_engine::{Error, Result, ResultExt};
use opendr_import::{ImportOptions, SafetensorsFile, is_exported_whisper};

use crate::card::{Import, ImportedNetwork};
use crate::import::imported;

/// Maximum size of a file in bytes; an ONNX file cannot exceed 2 GiB.
const MAX_BYTES: u64 = 1 << 31;

/// Name of a single network in a container.
const NETWORK: &str = "model.onnx";

/// Creates a container at `output` from a user's files, converted to ONNX: a model of TensorFlow Lite, TensorFlow.js (the JSON first,
/// then the weights) or ncnn (the `.param` file first, then the weights), or Whisper weights of CTranslate2, in safetensors, or in
/// two ONNX files exported by PyTorch (the encoder first). The format is detected from the content of the first file. Further
/// files, such as a tokeniser, are copied; a single ONNX file becomes `model.onnx`. Each of `named` is a name and a file, which is copied as
/// the name with the file's extension: `("text", "clip_text.onnx")` becomes `text.onnx`. `parts` are other models that the learner needs
/// ([`Zoo::default_parts`](crate::Zoo::default_parts)). The container replaces `output` only if `check` accepts it, for example because the
/// learner loads it.
///
/// # Errors
/// `NotFound` or `Io` for files that cannot be read, `Unsupported` for an unknown format, `InvalidInput` for a name that is none or taken, the
/// error of an invalid file, and that of `check`. `output` is then unchanged.
pub fn import_files(
    manifest: Manifest,
    files: &[impl AsRef<Path>],
    named: &[(String, PathBuf)],
    parts: &[(String, Model)],
    options: &ImportOptions,
    output: &Path,
    check: impl FnOnce(&Model) -> Result<()>,
) -> Result<Model> {
    let mut given = Vec::with_capacity(files.len());
    for path in files {
        let path = path.as_ref();
        let name = path.file_name().and_then(|name| name.to_str());
        let name = name.ok_or_else(|| Error::invalid_input(format!("{} is not a file", path.display())))?;
        given.push((name, read(path)?));
    }
    let given: Vec<_> = given.iter().map(|(name, bytes)| (*name, bytes.as_slice())).collect();
    let Some(&(first, bytes)) = given.first() else {
        return Err(Error::invalid_input("no files to import; give at least one"));
    };
    let format = Format::of(first, bytes)?;
    let import = format.import(options);
    let own = format.files(bytes)?.min(given.len());
    let mut writer = ModelWriter::new(output, manifest)?;
    match &import {
        Some(import) => {
            for (name, made) in imported(import, &given[..own]).context(|| first.to_owned())? {
                writer.add(name, &made)?;
            }
        }
        None => writer.add(NETWORK, bytes)?,
    }
    if import.is_none() && given[own..].iter().any(|(name, _)| *name == NETWORK) {
        return Err(Error::invalid_input(format!(
            "{NETWORK} is the name of the first network in a container; rename the other file of this name, or give it first"
        )));
    }
    for (name, bytes) in &given[own..] {
        writer.add(name, bytes)?;
    }
    for (name, path) in named {
        writer.add(&named_file(name, path)?, &read(path)?)?;
    }
    for (name, part) in parts {
        writer.add_part(name, part)?;
    }
    writer.finish_checked(check)
}

fn read(path: &Path) -> Result<Vec<u8>> {
    let context = || path.display().to_string();
    let size = path.metadata().context(context)?.len();
    if size > MAX_BYTES {
        let mb = size >> 20;
        return Err(Error::unsupported(format!(
            "{} has {mb} MB; at most 2048 MB are supported",
            path.display()
        )));
    }
    std::fs::read(path).context(context)
}

/// Returns the name in the container of a file that the user named.
fn named_file(name: &str, path: &Path) -> Result<String> {
    let is_word = |text: &str| {
        !text.is_empty() && text.chars().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_')
    };
    let extension = path.extension().and_then(|end| end.to_str()).map(str::to_lowercase);
    match extension {
        Some(extension) if is_word(name) && is_word(&extension) => Ok(format!("{name}.{extension}")),
        _ => Err(Error::invalid_input(format!(
            "{name}={} is no part of a model; the name has lower-case letters, digits and _, and the file an extension, such as \
             text=text.onnx",
            path.display()
        ))),
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Format {
    Onnx,
    Tfjs,
    Tflite,
    Ncnn,
    Ctranslate2Whisper,
    SafetensorsWhisper,
    OnnxWhisper,
}

impl Format {
    fn of(name: &str, bytes: &[u8]) -> Result<Self> {
        let text = bytes.trim_ascii_start();
        Ok(match () {
            () if bytes.get(4..8) == Some(b"TFL3") => Self::Tflite,
            () if bytes.get(6..17) == Some(b"WhisperSpec") => Self::Ctranslate2Whisper,
            () if SafetensorsFile::is_start(bytes) => Self::SafetensorsWhisper,
            () if text.starts_with(b"7767517") => Self::Ncnn,
            () if text.starts_with(b"{") => Self::Tfjs,
            () if is_exported_whisper(bytes) => Self::OnnxWhisper,
            () if name.to_lowercase().ends_with(".onnx") => Self::Onnx,
            () => {
                return Err(Error::unsupported(format!(
                    "{name} has no known format; give an .onnx, a .tflite, the JSON of a TensorFlow.js graph model, the \
                     .param of an ncnn model, or the model.bin (CTranslate2) or model.safetensors of a Whisper model"
                )));
            }
        })
    }

    /// Returns the conversion of the format; `None` for ONNX.
    fn import(self, options: &ImportOptions) -> Option<Import> {
        let network = || ImportedNetwork {
            image_size: options.image_size,
            outputs: options.outputs.clone(),
            ..Default::default()
        };
        match self {
            Self::Onnx => None,
            Self::Tfjs => Some(Import::Tfjs(network())),
            Self::Tflite => Some(Import::Tflite(network())),
            Self::Ncnn => Some(Import::Ncnn(network())),
            Self::Ctranslate2Whisper => Some(Import::Ctranslate2Whisper),
            Self::SafetensorsWhisper => Some(Import::SafetensorsWhisper),
            Self::OnnxWhisper => Some(Import::OnnxWhisper),
        }
    }

    /// Returns the number of leading files that form the model; `bytes` is the first file.
    fn files(self, bytes: &[u8]) -> Result<usize> {
        Ok(match self {
            Self::Tfjs => 1 + opendr_import::tfjs_weight_files(bytes)?.len(),
            Self::Ncnn | Self::OnnxWhisper => 2,
            Self::Onnx | Self::Tflite | Self::Ctranslate2Whisper | Self::SafetensorsWhisper => 1,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn named_files_have_the_name_and_their_extension() {
        let named = |name: &str, path: &str| named_file(name, Path::new(path));
        assert_eq!(named("text", "a/clip.text.ONNX").unwrap(), "text.onnx");
        for (name, path) in [("", "a.onnx"), ("../text", "a.onnx"), ("text", "a"), ("Text", "a.onnx")] {
            assert!(named(name, path).is_err(), "{name} {path}");
        }
    }

    #[test]
    fn named_files_are_in_the_container() {
        let folder = std::env::temp_dir().join(format!("opendr-import-parts-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        let [network, part] = ["net.onnx", "words.JSON"].map(|name| folder.join(name));
        std::fs::write(&network, b"network").unwrap();
        std::fs::write(&part, b"{}").unwrap();
        let import = |name: &str, path: &Path| {
            let named = [(name.to_owned(), path.to_owned())];
            let manifest = Manifest::new("learner", "");
            import_files(
                manifest,
                &[&network],
                &named,
                &[],
                &ImportOptions::default(),
                &folder.join("out"),
                |_| Ok(()),
            )
        };
        let model = import("tokenizer", &part).unwrap();
        assert_eq!(model.file("tokenizer.json").unwrap(), b"{}");
        assert_eq!(model.file("model.onnx").unwrap(), b"network");
        assert!(import("model", &network).is_err());
        let second = folder.join("model.onnx");
        std::fs::write(&second, b"decoder").unwrap();
        let files = [&network, &second];
        let (manifest, options) = (Manifest::new("learner", ""), ImportOptions::default());
        let refused = import_files(manifest, &files, &[], &[], &options, &folder.join("other"), |_| Ok(()));
        assert!(refused.unwrap_err().to_string().contains("rename the other file"));
        assert!(!folder.join("other").exists());
        std::fs::remove_dir_all(folder).ok();
    }

    #[test]
    fn format_is_detected_from_content() {
        let safetensors = [&2u64.to_le_bytes()[..], b"{}"].concat();
        let cases: [(&str, &[u8], Format); 7] = [
            ("a.bin", b"\x1c\0\0\0TFL3rest", Format::Tflite),
            ("model.bin", b"\x06\0\0\0\x0c\0WhisperSpec\0", Format::Ctranslate2Whisper),
            ("weights", &safetensors, Format::SafetensorsWhisper),
            ("a.param", b"7767517\n3 3\n", Format::Ncnn),
            ("model.json", b" {\"modelTopology\": {}}", Format::Tfjs),
            ("encoder_model.onnx", b"\x08\x08/layers.0/self_attn/q_proj/MatMul", Format::OnnxWhisper),
            ("Net.ONNX", b"\x08\x08", Format::Onnx),
        ];
        for (name, bytes, wanted) in cases {
            assert_eq!(Format::of(name, bytes).ok(), Some(wanted), "{name}");
        }
        assert!(Format::of("net.pth", b"PK\x03\x04").is_err());
    }
}
