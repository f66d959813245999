//! Models as others want them.

use std::fs;
use std::path::Path;

use opendr_engine::model::{Model, ModelWriter};
use opendr_engine::{Result, ResultExt};

/// Writes a model to `output`: the network alone when that ends in `.onnx`, else the container, as a zip when it ends in
/// `.zip`, or a folder.
///
/// # Errors
/// As [`Model::onnx`] and [`ModelWriter`]; `Integrity` when a file of the model is damaged.
pub fn export(model: &Model, output: &Path) -> Result<()> {
    if output.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("onnx")) {
        return fs::write(output, model.onnx()?).context(|| format!("writing {}", output.display()));
    }
    let mut writer = ModelWriter::new(output, model.manifest().clone())?;
    for file in &model.manifest().files {
        writer.add(&file.name, &model.file(&file.name)?)?;
    }
    writer.finish().map(drop)
}
