//! Parsing of `model.json`, and of OpenDR's own JSON.

use serde::Deserialize;
use serde::de::IgnoredAny;

use super::manifest::{FORMAT_VERSION, Manifest, parse};
use super::upstream;
use crate::{Error, Result};

#[derive(Deserialize)]
struct Probe {
    format_version: Option<u32>,
    model_paths: Option<IgnoredAny>,
    framework: Option<IgnoredAny>,
}

impl Manifest {
    /// Parses `model.json`, or OpenDR's own JSON if it points to ONNX files.
    ///
    /// # Errors
    /// Returns `Format` if it is neither, `Unsupported` if it is newer than this crate or points to weights of PyTorch or
    /// MXNet, `Integrity` if a file name leaves the folder.
    pub fn from_json(json: &[u8]) -> Result<Self> {
        let probe: Probe = parse(json)?;
        match probe.format_version {
            None if probe.model_paths.is_some() || probe.framework.is_some() => {
                upstream::manifest_from_json(json)
            }
            None => Err(Error::format(
                "no \"format_version\" and no \"model_paths\": this is not the JSON of a model",
            )),
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
}
