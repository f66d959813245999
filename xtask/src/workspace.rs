//! The crates of the workspace, from cargo's metadata.

use std::path::Path;

use serde_json::Value;

use crate::shell::{Result, command, output, root};

/// A crate of the workspace.
pub struct Package {
    /// Name in its manifest.
    pub name: String,
    /// Folder, relative to the root of the repository.
    pub folder: String,
    /// Roots of its libraries and programs, relative to the root of the repository; the library comes first.
    pub roots: Vec<String>,
    /// Names of the crates that it depends on, without those of its tests.
    pub dependencies: Vec<String>,
}

/// Returns the crates of the workspace.
pub fn packages() -> Result<Vec<Package>> {
    let metadata =
        output(command("cargo").args(["metadata", "--no-deps", "--offline", "--format-version", "1"]))?;
    let metadata: Value =
        serde_json::from_str(&metadata).map_err(|error| format!("cargo metadata: {error}"))?;
    metadata["packages"].as_array().into_iter().flatten().map(package).collect()
}

fn package(about: &Value) -> Result<Package> {
    let name = text(&about["name"])?;
    let manifest = relative(&text(&about["manifest_path"])?)?;
    let kinds = |target: &Value| -> Vec<String> {
        target["kind"].as_array().into_iter().flatten().filter_map(|kind| text(kind).ok()).collect()
    };
    let (mut libraries, mut programs) = (Vec::new(), Vec::new());
    for target in about["targets"].as_array().into_iter().flatten() {
        let kinds = kinds(target);
        let has = |names: &[&str]| kinds.iter().any(|kind| names.contains(&kind.as_str()));
        let source = relative(&text(&target["src_path"])?)?;
        match () {
            () if has(&["bin"]) => programs.push(source),
            () if has(&["test", "example", "bench", "custom-build"]) => (),
            () => libraries.push(source),
        }
    }
    let dependencies = about["dependencies"].as_array().into_iter().flatten();
    let mut dependencies: Vec<_> = dependencies
        .filter(|dependency| dependency["kind"] != "dev")
        .map(|dependency| text(&dependency["name"]))
        .collect::<Result<_>>()?;
    dependencies.sort();
    dependencies.dedup();
    let folder = manifest.trim_end_matches("/Cargo.toml").to_owned();
    Ok(Package { name, folder, roots: [libraries, programs].concat(), dependencies })
}

fn text(value: &Value) -> Result<String> {
    value.as_str().map(str::to_owned).ok_or_else(|| format!("cargo metadata: {value} is no text"))
}

fn relative(path: &str) -> Result<String> {
    let below = Path::new(path).strip_prefix(root());
    let below = below.map_err(|_| format!("cargo metadata: {path} is outside of the repository"))?;
    Ok(below.to_string_lossy().replace('\\', "/"))
}
