//! Model cards: the models of a learner, their licences and their sources.

use std::collections::BTreeMap;

use opendr_engine::model::{Licence, Sha256};
use opendr_engine::params::ParamMap;
use opendr_engine::{Error, Result, Task};
use serde::{Deserialize, Deserializer};
use serde_json::{Map, Value};

use crate::source::Source;

/// One file `models/<learner>.toml`. `models/README.md` describes the format.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
#[non_exhaustive]
pub struct Card {
    /// Kind of the items.
    #[serde(default)]
    pub kind: ItemKind,
    /// Registry name of the learner; for samples the name of the collection.
    pub learner: String,
    /// Task of the learner.
    #[serde(default)]
    pub task: Option<Task>,
    /// Description of the learner in one line.
    pub description: String,
    /// Variants, of which one is the default; empty if no pretrained weights are available.
    #[serde(default)]
    pub variants: Vec<Variant>,
}

/// Kind of the items of a card.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum ItemKind {
    /// Models for the card's learner.
    #[default]
    Model,
    /// Images and recordings to try a learner on.
    Sample,
}

/// One item of a card.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
#[non_exhaustive]
pub struct Variant {
    /// Name after the slash, such as `"coco_416"`.
    pub name: String,
    /// Whether it is the variant of a name without one.
    #[serde(default)]
    pub default: bool,
    /// Whether `opendr demo` uses it; true for one model and one image.
    #[serde(default)]
    pub demo: bool,
    /// Difference from the other variants, in one line.
    #[serde(default)]
    pub description: String,
    /// Name of the folder in a download to a user's folder, where programs of OpenDR 3.0 expect a certain name
    /// (default: `<learner>/<variant>`).
    #[serde(default)]
    pub folder: Option<String>,
    /// Name of the list of classes in `models/classes`.
    #[serde(default)]
    pub classes: Option<String>,
    /// Parameters of the learner for these weights.
    #[serde(default)]
    pub params: ParamMap,
    /// Layout, size and normalisation of the inputs.
    #[serde(default)]
    pub inputs: Map<String, Value>,
    /// Terms of use.
    pub licence: Licence,
    /// Accuracy on named data.
    #[serde(default)]
    pub metrics: Map<String, Value>,
    /// Speed and memory measured by `opendr bench`.
    #[serde(default)]
    pub speed: Option<Speed>,
    /// Files to download; empty for an algorithm without weights.
    #[serde(default)]
    pub files: Vec<CardFile>,
    /// Models of the zoo that it contains as parts (`Model::part`): name of the part, and item.
    #[serde(default)]
    pub parts: BTreeMap<String, String>,
    /// Conversions of the files into the model's networks; empty when the files need none.
    #[serde(default, deserialize_with = "one_or_several")]
    pub import: Vec<Import>,
    /// Sources of the files, in the order of use; empty without files.
    #[serde(default)]
    pub sources: Vec<Source>,
}

/// Speed and memory, as `opendr bench` measured them.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
#[non_exhaustive]
pub struct Speed {
    /// Frames per second from decoded image to targets, or calls per second; `None` for audio.
    pub fps: Option<f64>,
    /// Processing time per second of audio.
    pub real_time_factor: Option<f64>,
    /// Median time of a call, in milliseconds.
    pub p50_ms: Option<f64>,
    /// Peak memory of the process in MB (10^6 bytes).
    pub peak_mb: f64,
    /// CPU, threads and runtime of the measurement.
    #[serde(alias = "on")]
    pub measured_on: String,
}

/// One file that an item needs.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
#[non_exhaustive]
pub struct CardFile {
    /// Name inside the container.
    pub name: String,
    /// Size in bytes.
    pub size: u64,
    /// SHA-256 checksum.
    pub sha256: Sha256,
}

/// Conversion of files of another format to ONNX; a table in the card, or a list of tables.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize)]
#[serde(tag = "format", rename_all = "snake_case", deny_unknown_fields)]
#[non_exhaustive]
pub enum Import {
    /// A TensorFlow.js graph model: the JSON file first, then its weights in the order of the JSON.
    Tfjs(ImportedNetwork),
    /// A TensorFlow Lite model, one file.
    Tflite(ImportedNetwork),
    /// An ncnn model: the `.param` file, then the weights.
    Ncnn(ImportedNetwork),
    /// A Whisper model of CTranslate2: its `model.bin` first, from which `encoder.onnx` and `decoder.onnx` are made; other files are
    /// copied into the container.
    Ctranslate2Whisper,
    /// A Whisper model of transformers: its `model.safetensors` first; else as `Ctranslate2Whisper`.
    SafetensorsWhisper,
    /// A Whisper model exported by PyTorch: its `encoder_model.onnx`, then its `decoder_model.onnx`; else as `Ctranslate2Whisper`.
    OnnxWhisper,
}

/// One network converted from files of another format.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ImportedNetwork {
    /// Names of the card's files to convert; all when empty.
    #[serde(default)]
    pub files: Vec<String>,
    /// Name of the written file.
    #[serde(default = "model_onnx")]
    pub output: String,
    /// Height and width of an image input of dynamic shape.
    #[serde(default)]
    pub image_size: Option<(usize, usize)>,
    /// Outputs to keep; all when empty.
    #[serde(default)]
    pub outputs: Vec<String>,
}

impl Default for ImportedNetwork {
    fn default() -> Self {
        Self { files: Vec::new(), output: model_onnx(), image_size: None, outputs: Vec::new() }
    }
}

impl Import {
    /// Files written for a Whisper model.
    pub(crate) const WHISPER: [&'static str; 2] = ["encoder.onnx", "decoder.onnx"];

    /// Returns the names of the written files.
    pub fn outputs(&self) -> Vec<&str> {
        match self {
            Self::Tfjs(network) | Self::Tflite(network) | Self::Ncnn(network) => vec![&network.output],
            Self::Ctranslate2Whisper | Self::SafetensorsWhisper | Self::OnnxWhisper => Self::WHISPER.to_vec(),
        }
    }

    /// Returns the names of the card's files to convert; empty means all.
    pub(crate) fn named_files(&self) -> &[String] {
        match self {
            Self::Tfjs(network) | Self::Tflite(network) | Self::Ncnn(network) => &network.files,
            Self::Ctranslate2Whisper | Self::SafetensorsWhisper | Self::OnnxWhisper => &[],
        }
    }

    /// Returns those of `files` that are converted, in the order of their names in the import.
    pub(crate) fn files_of<'a>(&self, files: &'a [CardFile]) -> Vec<&'a CardFile> {
        match self.named_files() {
            [] => files.iter().collect(),
            names => names.iter().filter_map(|name| files.iter().find(|file| file.name == *name)).collect(),
        }
    }
}

fn one_or_several<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<Import>, D::Error> {
    #[derive(Deserialize)]
    #[serde(untagged)]
    enum OneOrSeveral {
        One(Import),
        Several(Vec<Import>),
    }
    Ok(match OneOrSeveral::deserialize(deserializer)? {
        OneOrSeveral::One(import) => vec![import],
        OneOrSeveral::Several(imports) => imports,
    })
}

fn model_onnx() -> String {
    "model.onnx".to_owned()
}

impl Card {
    /// Returns the variant called `name`, or the default one.
    ///
    /// # Errors
    /// `NotFound`, with the existing names.
    pub fn variant(&self, name: Option<&str>) -> Result<&Variant> {
        if self.variants.is_empty() {
            return Err(Error::not_found(format!(
                "{0} has no pretrained weights: train it on your own data (opendr fit {0})",
                self.learner
            )));
        }
        let named = |variant: &&Variant| name.map_or(variant.default, |name| variant.name == name);
        self.variants.iter().find(named).ok_or_else(|| {
            let names: Vec<_> = self.variants.iter().map(|variant| variant.name.as_str()).collect();
            Error::not_found(format!(
                "{} has no variant {:?}; there are {}",
                self.learner,
                name.unwrap_or("default"),
                names.join(", ")
            ))
        })
    }
}

impl Variant {
    /// Returns the total size of its files in bytes; a package that contains them may be larger.
    pub fn size(&self) -> u64 {
        self.files.iter().map(|file| file.size).sum()
    }
}
