//! Export of models as containers and ONNX files.

use std::fs;
use std::path::Path;

use opendr_engine::model::{Model, ModelWriter};
use opendr_engine::{Result, ResultExt};
use opendr_rl::{POLICY_FILE, Policy, onnx_from_policy};

/// Writes a model to `output`: the network alone if the path ends in `.onnx`, else the container, as a zip if it ends in
/// `.zip`, or as a folder.
///
/// # Errors
/// As [`network`] and [`ModelWriter`]; `Integrity` when a file of the model is damaged.
pub fn export(model: &Model, output: &Path) -> Result<()> {
    if output.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("onnx")) {
        return fs::write(output, network(model)?).context(|| format!("writing {}", output.display()));
    }
    let mut writer = ModelWriter::new(output, model.manifest().clone())?;
    for file in &model.manifest().files {
        writer.add(&file.name, &model.file(&file.name)?)?;
    }
    writer.finish().map(drop)
}

/// Returns the model's network as an ONNX file. That of a policy, whose container holds parameters only, is built.
///
/// # Errors
/// As [`Model::onnx`]; `Unsupported` for a policy that ONNX cannot express.
pub fn network(model: &Model) -> Result<Vec<u8>> {
    let files = &model.manifest().files;
    let has = |wanted: &dyn Fn(&str) -> bool| files.iter().any(|file| wanted(&file.name));
    if has(&|name| name == POLICY_FILE) && !has(&|name| name.ends_with(".onnx")) {
        return onnx_from_policy(&Policy::from_bytes(&model.file(POLICY_FILE)?)?);
    }
    model.onnx()
}
