//! What `model.json` says.

use std::collections::HashSet;

use serde::de::{DeserializeOwned, IgnoredAny};
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

use super::{Sha256, member_path, upstream};
use crate::params::ParamMap;
use crate::target::Classes;
use crate::{Error, Result, Task};

/// The newest version of the format, which this code writes.
pub const FORMAT_VERSION: u32 = 1;

/// `model.json`: everything about a model but its weights. Unknown fields are ignored.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Manifest {
    /// Version of the format; a newer one than [`FORMAT_VERSION`] is refused.
    pub format_version: u32,
    /// Registry name of the learner that reads the model, e.g. `"nanodet"`; empty when unknown.
    #[serde(default)]
    pub learner: String,
    /// Which of the learner's models it is, e.g. `"coco_416"`; empty when it is the user's own.
    #[serde(default)]
    pub variant: String,
    /// What the model is for.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub task: Option<Task>,
    /// The learner's parameters that belong to these weights.
    #[serde(default)]
    pub params: ParamMap,
    /// Names of the classes, in the order of the outputs.
    #[serde(default)]
    pub classes: Classes,
    /// Layout, size and normalisation of the inputs, as the learner wants them written.
    #[serde(default)]
    pub inputs: Map<String, Value>,
    /// The files of the model.
    #[serde(default)]
    pub files: Vec<ModelFile>,
    /// Under which terms it may be used.
    #[serde(default)]
    pub licence: Licence,
    /// What was measured, e.g. `{"coco128_val": {"map50": 0.533}}`.
    #[serde(default)]
    pub metrics: Map<String, Value>,
    /// Where the model comes from.
    #[serde(default)]
    pub lineage: Lineage,
}

/// One file of a model.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct ModelFile {
    /// Name inside the container, with forward slashes.
    pub name: String,
    /// Bytes; absent in OpenDR's own JSON only.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub size: Option<u64>,
    /// Checksum; absent in OpenDR's own JSON only.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sha256: Option<Sha256>,
}

/// Terms of use, as SPDX names where there is one; empty when unknown.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub struct Licence {
    /// Of the code and the network's definition.
    pub code: String,
    /// Of the weights.
    pub weights: String,
    /// Of the data that they were trained on.
    pub data: String,
    /// Whether commercial use is allowed; `None` when nobody has found out.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub commercial: Option<bool>,
}

/// How a model came to be.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub struct Lineage {
    /// Where the original was got.
    pub source: String,
    /// What turned it into this form, with its version; empty when nothing had to.
    pub importer: String,
    /// The command that made it.
    pub command: String,
}

#[derive(Deserialize)]
struct Probe {
    format_version: Option<u32>,
    model_paths: Option<IgnoredAny>,
    framework: Option<IgnoredAny>,
}

impl Manifest {
    /// An otherwise empty manifest of `learner`'s model `variant`.
    pub fn new(learner: impl Into<String>, variant: impl Into<String>) -> Self {
        Self {
            format_version: FORMAT_VERSION,
            learner: learner.into(),
            variant: variant.into(),
            task: None,
            params: ParamMap::new(),
            classes: Classes::default(),
            inputs: Map::new(),
            files: Vec::new(),
            licence: Licence::default(),
            metrics: Map::new(),
            lineage: Lineage::default(),
        }
    }

    /// What [`inputs`](Self::inputs) say, read as a type of the learner's; `what` names it in the error.
    ///
    /// # Errors
    /// `Format` where they say something else.
    pub fn read_inputs<T: DeserializeOwned>(&self, what: &str) -> Result<T> {
        serde_json::from_value(Value::Object(self.inputs.clone())).map_err(|error| {
            Error::format(format!("the model's \"inputs\" do not tell {what}; train or get it anew"))
                .with_source(error)
        })
    }

    /// Replaces [`inputs`](Self::inputs) by what a type of the learner's says, for [`Manifest::read_inputs`].
    ///
    /// # Errors
    /// `Internal` for a type that has no names in JSON.
    pub fn write_inputs(&mut self, layout: &impl Serialize) -> Result<()> {
        self.inputs = match serde_json::to_value(layout) {
            Ok(Value::Object(inputs)) => inputs,
            Ok(_) => return Err(Error::internal("a layout is no object")),
            Err(error) => return Err(Error::internal("a layout has no JSON form").with_source(error)),
        };
        Ok(())
    }

    /// Reads `model.json`, or OpenDR's own JSON when it points to ONNX files.
    ///
    /// # Errors
    /// `Format` when it is neither, `Unsupported` when it is newer than this code or points to weights of PyTorch or
    /// MXNet, `Integrity` when a file name leaves the folder.
    pub fn from_json(json: &[u8]) -> Result<Self> {
        let probe: Probe = parse(json)?;
        match probe.format_version {
            None if probe.model_paths.is_some() || probe.framework.is_some() => {
                upstream::manifest_from_json(json)
            }
            None => {
                Err(Error::format("no \"format_version\" and no \"model_paths\": this is no model's JSON"))
            }
            Some(newer @ FORMAT_VERSION..) if newer > FORMAT_VERSION => Err(Error::unsupported(format!(
                "format version {newer}, but this OpenDR reads up to {FORMAT_VERSION}: update OpenDR"
            ))),
            Some(0) => Err(Error::format("format version 0: the first is 1")),
            Some(_) => {
                let manifest: Self = parse(json)?;
                manifest.check_files()?;
                Ok(manifest)
            }
        }
    }

    /// The text of `model.json`.
    ///
    /// # Errors
    /// `Internal`, which a manifest read or built here never gives.
    pub fn to_json(&self) -> Result<Vec<u8>> {
        serde_json::to_vec_pretty(self)
            .map_err(|error| Error::internal("the manifest cannot be written as JSON").with_source(error))
    }

    fn check_files(&self) -> Result<()> {
        let mut seen = HashSet::new();
        for file in &self.files {
            member_path(&file.name)?;
            if file.size.is_none() || file.sha256.is_none() {
                return Err(Error::format(format!("the file {:?} has no size or no sha256", file.name)));
            }
            if !seen.insert(file.name.to_lowercase()) {
                return Err(Error::format(format!("the file {:?} is named twice", file.name)));
            }
        }
        Ok(())
    }
}

pub(super) fn parse<'a, T: Deserialize<'a>>(json: &'a [u8]) -> Result<T> {
    serde_json::from_slice(json).map_err(|error| Error::format("the JSON does not fit").with_source(error))
}
