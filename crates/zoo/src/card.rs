//! Model cards: what a learner's models are, under which terms, and where they come from.

use std::collections::BTreeMap;

use opendr_engine::model::{Licence, Sha256};
use opendr_engine::params::ParamMap;
use opendr_engine::{Error, Result, Task};
use serde::{Deserialize, Deserializer};
use serde_json::{Map, Value};

use crate::check::check_card;
use crate::source::Source;

/// One file `models/<learner>.toml`. `models/README.md` describes the format.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
#[non_exhaustive]
pub struct Card {
    /// What its items are.
    #[serde(default)]
    pub kind: ItemKind,
    /// Registry name of the learner; for samples the name of the collection.
    pub learner: String,
    /// What the learner is for.
    #[serde(default)]
    pub task: Option<Task>,
    /// The learner in one line.
    pub description: String,
    /// The variants, of which one is the default; none where nobody gives weights away and users train their own.
    #[serde(default)]
    pub variants: Vec<Variant>,
}

/// What the items of a card are.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum ItemKind {
    /// Models for the card's learner.
    #[default]
    Model,
    /// Pictures and recordings to try a learner on.
    Sample,
}

/// One item of a card.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
#[non_exhaustive]
pub struct Variant {
    /// The name after the slash, e.g. `"coco_416"`.
    pub name: String,
    /// Whether it is meant when no variant is named.
    #[serde(default)]
    pub default: bool,
    /// Whether `opendr demo` shows it: one model, and one picture.
    #[serde(default)]
    pub demo: bool,
    /// What distinguishes it, in one line.
    #[serde(default)]
    pub description: String,
    /// The folder that a download to a folder of the user's makes, where OpenDR's programs count on its name;
    /// `<learner>/<variant>` without.
    #[serde(default)]
    pub folder: Option<String>,
    /// Name of the list in `models/classes` that names its classes.
    #[serde(default)]
    pub classes: Option<String>,
    /// The learner's parameters that belong to these weights.
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
    /// What `opendr bench` measured.
    #[serde(default)]
    pub speed: Option<Speed>,
    /// The files to get; none for a rule, which has no weights.
    #[serde(default)]
    pub files: Vec<CardFile>,
    /// Models of the zoo that it carries as parts (`Model::part`): the name of the part, and the item.
    #[serde(default)]
    pub parts: BTreeMap<String, String>,
    /// How the model's files are made from them, one network each; empty when they are the model.
    #[serde(default, deserialize_with = "one_or_several")]
    pub import: Vec<Import>,
    /// Where the files are, in the order in which to try; none where there are no files.
    #[serde(default)]
    pub sources: Vec<Source>,
}

/// Speed and memory, as `opendr bench` measured them.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
#[non_exhaustive]
pub struct Speed {
    /// Frames a second from decoded picture to targets, or calls a second; none of a sound.
    pub fps: Option<f64>,
    /// Of a sound, the time for a second of it.
    pub real_time_factor: Option<f64>,
    /// Median time of a call, milliseconds.
    pub p50_ms: Option<f64>,
    /// Peak memory of the process in MB (10^6 bytes).
    pub peak_mb: f64,
    /// Processor, threads, runtime.
    pub on: String,
}

/// One file that an item needs.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
#[non_exhaustive]
pub struct CardFile {
    /// Name inside the container.
    pub name: String,
    /// Bytes.
    pub size: u64,
    /// Checksum.
    pub sha256: Sha256,
}

/// How files of another format become ONNX files; a table in the card, or a list of tables.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize)]
#[serde(tag = "format", rename_all = "snake_case", deny_unknown_fields)]
#[non_exhaustive]
pub enum Import {
    /// A TensorFlow.js graph model: the first of the files is its JSON, the others are its weights in the JSON's order.
    Tfjs(ImportedNetwork),
    /// A TensorFlow Lite model, one file.
    Tflite(ImportedNetwork),
    /// A model of ncnn's: the text of its layers, then its weights.
    Ncnn(ImportedNetwork),
    /// A Whisper that CTranslate2 converted: the first of the files is its `model.bin`, of which `encoder.onnx` and
    /// `decoder.onnx` are made; the others go into the container as they are.
    Ctranslate2Whisper,
    /// A Whisper that transformers saved: the first of the files is its `model.safetensors`; else as `Ctranslate2Whisper`.
    SafetensorsWhisper,
    /// A Whisper that PyTorch exported: the first of the files is its `encoder_model.onnx`, the second its `decoder_model.onnx`;
    /// else as `Ctranslate2Whisper`.
    OnnxWhisper,
}

/// One network that is made of files of another format.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ImportedNetwork {
    /// Which of the card's files it is made of; all when empty.
    #[serde(default)]
    pub files: Vec<String>,
    /// Name of the file that is made.
    #[serde(default = "model_onnx")]
    pub output: String,
    /// Height and width of an image input whose size the model leaves open.
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
    /// What is made of a Whisper.
    pub(crate) const WHISPER: [&'static str; 2] = ["encoder.onnx", "decoder.onnx"];

    /// Names of the files that are made.
    pub fn outputs(&self) -> Vec<&str> {
        match self {
            Self::Tfjs(network) | Self::Tflite(network) | Self::Ncnn(network) => vec![&network.output],
            Self::Ctranslate2Whisper | Self::SafetensorsWhisper | Self::OnnxWhisper => Self::WHISPER.to_vec(),
        }
    }

    /// Those of the card's files that it names; all are meant when it names none.
    pub(crate) fn named_files(&self) -> &[String] {
        match self {
            Self::Tfjs(network) | Self::Tflite(network) | Self::Ncnn(network) => &network.files,
            Self::Ctranslate2Whisper | Self::SafetensorsWhisper | Self::OnnxWhisper => &[],
        }
    }

    /// Which of `files` it is made of, in the order in which it names them.
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
    /// Reads a card and checks that everything in it is sound: names, paths, addresses, sizes, one default.
    ///
    /// # Errors
    /// `Format` when it is no card, `Integrity` when a name in it could leave its folder.
    pub fn from_toml(text: &str) -> Result<Self> {
        if text.len() > MAX_CARD_BYTES {
            return Err(Error::format(format!("a card of {} bytes: at most {MAX_CARD_BYTES}", text.len())));
        }
        let card: Self = toml::from_str(text)
            .map_err(|error| Error::format("the card does not fit").with_source(error))?;
        check_card(&card).map_err(|error| error.context(format!("the card {:?}", card.learner)))?;
        Ok(card)
    }

    /// The variant called `name`, or the default one.
    ///
    /// # Errors
    /// `NotFound`, naming those there are.
    pub fn variant(&self, name: Option<&str>) -> Result<&Variant> {
        if self.variants.is_empty() {
            return Err(Error::not_found(format!(
                "nobody gives weights of {0} away: train it on your own data (opendr fit {0})",
                self.learner
            )));
        }
        let wanted = |variant: &&Variant| name.map_or(variant.default, |name| variant.name == name);
        self.variants.iter().find(wanted).ok_or_else(|| {
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
    /// What its files take together, in bytes; a package that carries them may be larger.
    pub fn size(&self) -> u64 {
        self.files.iter().map(|file| file.size).sum()
    }
}

const MAX_CARD_BYTES: usize = 1 << 20;
