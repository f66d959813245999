//! Reading of the JSON files that the learners of OpenDR 3.0 write beside their weights.

use std::path::Path;

use serde::Deserialize;
use serde_json::{Map, Value};

use super::manifest::{Manifest, ModelFile, parse};
use super::member_path;
use crate::params::{ParamMap, ParamValue};
use crate::{Error, Result};

#[derive(Deserialize)]
struct Metadata {
    #[serde(default)]
    model_paths: Paths,
    #[serde(default)]
    framework: String,
    #[serde(default)]
    format: String,
    #[serde(default)]
    inference_params: Value,
    #[serde(flatten)]
    rest: Map<String, Value>,
}

#[derive(Deserialize)]
#[serde(untagged)]
enum Paths {
    One(String),
    Many(Vec<String>),
}

impl Default for Paths {
    fn default() -> Self {
        Self::Many(Vec::new())
    }
}

/// Converts an OpenDR JSON to a manifest. Its files have no size and no checksum, and its learner is unknown.
pub(super) fn manifest_from_json(json: &[u8]) -> Result<Manifest> {
    let metadata: Metadata = parse(json)?;
    let paths = match metadata.model_paths {
        Paths::One(path) => vec![path],
        Paths::Many(paths) => paths,
    };
    // CoTransEnc writes the format "pth" for ONNX, so the extension of the files counts too.
    let is_onnx = |path: &String| path.to_ascii_lowercase().ends_with(".onnx");
    if metadata.format != "onnx" && (paths.is_empty() || !paths.iter().all(is_onnx)) {
        return Err(Error::unsupported(format!(
            "OpenDR JSON with weights of {} in the format {:?}; OpenDR in Rust reads ONNX. In OpenDR 3.0 call \
             optimize() and then save(), which writes ONNX, and load that",
            if metadata.framework.is_empty() { "an unnamed framework" } else { &metadata.framework },
            metadata.format,
        )));
    }
    if paths.is_empty() {
        return Err(Error::format("\"model_paths\" names no file"));
    }
    let mut manifest = Manifest::new("", "");
    manifest.files = paths.iter().map(|path| file_from_path(path)).collect::<Result<_>>()?;
    manifest.params = params_from_json(&metadata.inference_params, &metadata.rest);
    let classes = metadata.rest.get("classes").or_else(|| metadata.inference_params.get("classes"));
    if let Some(Value::Array(names)) = classes {
        manifest.classes = names.iter().filter_map(Value::as_str).collect();
    }
    manifest.lineage.source = "OpenDR".into();
    Ok(manifest)
}

// Some learners write the path joined with the folder of the caller, so only the last component is valid.
fn file_from_path(path: &str) -> Result<ModelFile> {
    let name = Path::new(path).file_name().and_then(|name| name.to_str()).unwrap_or_default();
    member_path(name)?;
    Ok(ModelFile { name: name.to_owned(), size: None, sha256: None })
}

fn params_from_json(inference_params: &Value, rest: &Map<String, Value>) -> ParamMap {
    let inner = inference_params.as_object().into_iter().flatten();
    let known = ["classes", "has_data", "optimized", "optimizer_info", "optimimizer_info"];
    rest.iter()
        .chain(inner)
        .filter(|(name, _)| !known.contains(&name.as_str()))
        .filter_map(|(name, value)| Some((name.clone(), ParamValue::deserialize(value).ok()?)))
        .collect()
}
