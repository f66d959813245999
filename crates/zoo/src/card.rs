//! Model cards: the models of a learner, their licences and their sources.

use std::collections::BTreeMap;
use std::fmt;
use std::str::FromStr;

use opendr_engine::model::{Licence, Sha256};
use opendr_engine::params::ParamMap;
use opendr_engine::{Error, Result, Task};
use serde::{Deserialize, Deserializer, Serialize};
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
    /// Data that the weights were trained and measured on; `None` for an algorithm without weights.
    #[serde(default)]
    pub grade: Option<Grade>,
    /// Accuracy on named data.
    #[serde(default)]
    pub metrics: Map<String, Value>,
    /// The one of `metrics` to compare models by.
    #[serde(default)]
    pub headline: Option<Headline>,
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

/// Data that weights were trained and measured on; a later one is better.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Deserialize, Serialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum Grade {
    /// Not measured on real data: learnt in simulation or from drawings.
    Demonstration,
    /// Measured on real data, trained on others.
    Transfer,
    /// Trained and measured on real data.
    Real,
}

impl Grade {
    /// All grades, the best first.
    pub const ALL: [Self; 3] = [Self::Real, Self::Transfer, Self::Demonstration];

    /// Returns its name in a card.
    pub fn name(self) -> &'static str {
        match self {
            Self::Demonstration => "demonstration",
            Self::Transfer => "transfer",
            Self::Real => "real",
        }
    }
}

impl FromStr for Grade {
    type Err = Error;

    fn from_str(name: &str) -> Result<Self> {
        Self::ALL.into_iter().find(|grade| grade.name() == name).ok_or_else(|| {
            let names = Self::ALL.map(Self::name).join(", ");
            Error::invalid_input(format!("unknown grade {name:?}; the grades are {names}"))
        })
    }
}

/// Which of a variant's metrics models are compared by, and its confidence interval.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
#[non_exhaustive]
pub struct Headline {
    /// Data set: a key of the variant's metrics.
    pub data: String,
    /// Metric: a key of the data set's numbers.
    pub metric: String,
    /// Lower and upper bound of the 95 % confidence interval: `opendr eval`'s bootstrap, or Wilson's for a share.
    #[serde(default)]
    pub interval: Option<(f64, f64)>,
    /// Key of the number of samples among the data set's numbers.
    #[serde(default = "samples")]
    pub of: String,
}

/// The accuracy of a variant: the number that its headline names.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Accuracy<'a> {
    /// Data set.
    pub data: &'a str,
    /// Metric.
    pub metric: &'a str,
    /// Value of the metric.
    pub value: f64,
    /// Lower and upper bound of the 95 % confidence interval, if known.
    pub interval: Option<(f64, f64)>,
    /// Number of samples, if known.
    pub count: Option<u64>,
    /// What was counted: `"samples"`, `"faces"`.
    pub of: &'a str,
}

impl fmt::Display for Accuracy<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {}", self.value, self.metric)?;
        if let Some((low, high)) = self.interval {
            write!(f, " ({low} to {high})")?;
        }
        match self.count {
            Some(count) => write!(f, ", {count} {} of {}", self.of, self.data),
            None => write!(f, ", {}", self.data),
        }
    }
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

fn samples() -> String {
    "samples".to_owned()
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

    /// Returns the accuracy that the headline names; `None` without one.
    pub fn accuracy(&self) -> Option<Accuracy<'_>> {
        let Headline { data, metric, interval, of } = self.headline.as_ref()?;
        let numbers = self.metrics.get(data)?;
        let value = numbers.get(metric)?.as_f64()?;
        let count = numbers.get(of).and_then(Value::as_u64);
        Some(Accuracy { data, metric, value, interval: *interval, count, of })
    }

    /// Returns whether it consists of weights, its own or those of its parts.
    pub fn has_weights(&self) -> bool {
        !self.files.is_empty() || !self.parts.is_empty()
    }
}
