//! The manifest of a model, `model.json`.

use std::collections::HashSet;
use std::path::Path;

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

use super::{Sha256, member_path};
use crate::params::ParamMap;
use crate::target::Classes;
use crate::{Error, Result, Task};

/// Newest version of the format, which this crate writes.
pub const FORMAT_VERSION: u32 = 1;

/// The contents of `model.json`: everything about a model except its weights. Unknown fields are ignored.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Manifest {
    /// Version of the format; newer ones than [`FORMAT_VERSION`] are rejected.
    pub format_version: u32,
    /// Registry name of the learner that loads the model, e.g. `"nanodet"`; empty if unknown.
    #[serde(default)]
    pub learner: String,
    /// Name of the variant, e.g. `"coco_416"`; empty for a user's own model.
    #[serde(default)]
    pub variant: String,
    /// Task of the model.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub task: Option<Task>,
    /// Parameters of the learner for these weights.
    #[serde(default)]
    pub params: ParamMap,
    /// Names of the classes, in the order of the outputs.
    #[serde(default)]
    pub classes: Classes,
    /// Layout, size and normalisation of the inputs, in the form of the learner.
    #[serde(default)]
    pub inputs: Map<String, Value>,
    /// Files of the model.
    #[serde(default)]
    pub files: Vec<ModelFile>,
    /// Terms of use.
    #[serde(default)]
    pub licence: Licence,
    /// Measured metrics, e.g. `{"coco128_val": {"map50": 0.533}}`.
    #[serde(default)]
    pub metrics: Map<String, Value>,
    /// Origin of the model.
    #[serde(default)]
    pub lineage: Lineage,
}

/// A file of a model.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct ModelFile {
    /// Name inside the container, with forward slashes.
    pub name: String,
    /// Size in bytes; absent only in OpenDR's own JSON.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub size: Option<u64>,
    /// Checksum; absent only in OpenDR's own JSON.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sha256: Option<Sha256>,
}

/// Terms of use, as SPDX identifiers if there are; empty if unknown.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub struct Licence {
    /// Licence of the code and the network definition.
    pub code: String,
    /// Licence of the weights.
    pub weights: String,
    /// Licence of the training data.
    pub data: String,
    /// Whether commercial use is allowed; `None` if unknown.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub commercial: Option<bool>,
}

/// Origin of a model.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub struct Lineage {
    /// Source of the original model.
    pub source: String,
    /// Tool that converted the original, with its version; empty without conversion.
    pub importer: String,
    /// Command that created the model.
    pub command: String,
}

impl Manifest {
    /// Creates a manifest of `learner`'s model `variant`, otherwise empty.
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

    /// Creates the manifest of an ONNX file that is not in a container.
    pub(super) fn of_network(path: &Path) -> Result<Self> {
        let name = path.file_name().and_then(|name| name.to_str()).unwrap_or_default();
        member_path(name)?;
        let file = ModelFile { name: name.to_owned(), size: None, sha256: None };
        Ok(Self { files: vec![file], ..Self::new("", "") })
    }

    /// Parses [`inputs`](Self::inputs) as a type of the learner; `what` names its contents in the error.
    ///
    /// # Errors
    /// Returns `Format` if they do not fit the type.
    pub fn read_inputs<T: DeserializeOwned>(&self, what: &str) -> Result<T> {
        serde_json::from_value(Value::Object(self.inputs.clone())).map_err(|error| {
            Error::format(format!(
                "the model's \"inputs\" do not state {what}; train or download the model again"
            ))
            .with_source(error)
        })
    }

    /// Replaces [`inputs`](Self::inputs) by a value of a type of the learner, for [`Manifest::read_inputs`].
    ///
    /// # Errors
    /// Returns `Internal` if the value is not a JSON object.
    pub fn write_inputs(&mut self, layout: &impl Serialize) -> Result<()> {
        self.inputs = match serde_json::to_value(layout) {
            Ok(Value::Object(inputs)) => inputs,
            Ok(_) => return Err(Error::internal("a layout is not a JSON object")),
            Err(error) => return Err(Error::internal("a layout has no JSON form").with_source(error)),
        };
        Ok(())
    }

    /// Returns the text of `model.json`.
    ///
    /// # Errors
    /// Returns `Internal` if the manifest cannot be written, which does not occur for manifests read or built here.
    pub fn to_json(&self) -> Result<Vec<u8>> {
        serde_json::to_vec_pretty(self)
            .map_err(|error| Error::internal("the manifest cannot be written as JSON").with_source(error))
    }

    /// Checks that every file has a valid and unique name, a size and a checksum.
    pub(super) fn check_files(&self) -> Result<()> {
        let mut names = HashSet::new();
        for file in &self.files {
            member_path(&file.name)?;
            if file.size.is_none() || file.sha256.is_none() {
                return Err(Error::format(format!("the file {:?} has no size or no sha256", file.name)));
            }
            if !names.insert(file.name.to_lowercase()) {
                return Err(Error::format(format!("the file {:?} is listed twice", file.name)));
            }
        }
        Ok(())
    }
}

pub(super) fn parse<'a, T: Deserialize<'a>>(json: &'a [u8]) -> Result<T> {
    serde_json::from_slice(json)
        .map_err(|error| Error::format("the JSON is not that of a model").with_source(error))
}
