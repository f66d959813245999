//! The crates that a program or library of the workspace consists of: its dependencies without those of builds and tests.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use serde_json::Value;

use crate::shell::{Result, command, output, root};

/// A crate that is linked.
pub struct Linked {
    /// Name and version.
    pub name: String,
    pub version: String,
    /// Licence expression of its manifest; empty if the manifest names a file instead.
    pub licence: String,
    /// Authors of its manifest.
    pub authors: Vec<String>,
    /// Sentence about it.
    pub description: Option<String>,
    /// Address of its sources.
    pub repository: Option<String>,
    /// Folder of its sources on this machine.
    pub folder: PathBuf,
    /// SHA-256 of the published crate; `None` for the crates of the workspace.
    pub checksum: Option<String>,
    /// Names and versions of the linked crates that it depends on.
    pub dependencies: Vec<(String, String)>,
}

impl Linked {
    /// Returns whether it is a crate of the workspace.
    pub fn is_ours(&self) -> bool {
        self.folder.starts_with(root())
    }
}

/// What is built: packages of the workspace with features, for a target.
pub struct Build<'a> {
    /// Packages of the workspace.
    pub packages: &'a [&'a str],
    /// Features, as `package/feature`.
    pub features: &'a [&'a str],
}

/// Returns the crates linked by a build for this machine, sorted by name and version.
pub fn crates(build: &Build) -> Result<Vec<Linked>> {
    let host = host()?;
    let names = names(build, &host)?;
    let mut metadata = command("cargo");
    metadata.args(["metadata", "--locked", "--format-version", "1", "--filter-platform", &host]);
    let metadata: Value =
        serde_json::from_str(&output(&mut metadata)?).map_err(|error| format!("cargo metadata: {error}"))?;
    let checksums = checksums()?;
    let mut by_id = BTreeMap::new();
    for about in metadata["packages"].as_array().into_iter().flatten() {
        let key = (text(&about["name"]), text(&about["version"]));
        if names.contains(&key) {
            by_id.insert(text(&about["id"]), (key, about));
        }
    }
    let mut linked = Vec::new();
    for node in metadata["resolve"]["nodes"].as_array().into_iter().flatten() {
        let Some((key, about)) = by_id.get(&text(&node["id"])) else { continue };
        let normal = |dependency: &&Value| {
            let mut kinds = dependency["dep_kinds"].as_array().into_iter().flatten();
            kinds.any(|kind| kind["kind"].is_null())
        };
        let dependencies = node["deps"].as_array().into_iter().flatten().filter(normal);
        let dependencies: BTreeSet<_> = dependencies
            .filter_map(|dependency| Some(by_id.get(&text(&dependency["pkg"]))?.0.clone()))
            .collect();
        let manifest = PathBuf::from(text(&about["manifest_path"]));
        linked.push(Linked {
            name: key.0.clone(),
            version: key.1.clone(),
            licence: text(&about["license"]),
            authors: about["authors"].as_array().into_iter().flatten().map(text).collect(),
            description: about["description"].as_str().map(str::to_owned),
            repository: about["repository"].as_str().map(str::to_owned),
            folder: manifest.parent().unwrap_or(Path::new("/")).to_owned(),
            checksum: checksums.get(key).cloned(),
            dependencies: dependencies.into_iter().collect(),
        });
    }
    linked.sort_by(|a, b| (&a.name, &a.version).cmp(&(&b.name, &b.version)));
    Ok(linked)
}

/// Returns the target that the compiler builds for.
pub fn host() -> Result<String> {
    let about = output(command("rustc").arg("-vV"))?;
    let host = about.lines().find_map(|line| line.strip_prefix("host: "));
    host.map(str::to_owned).ok_or_else(|| "rustc -vV names no host".to_owned())
}

/// Returns names and versions of the linked crates. `cargo tree` resolves the features of these packages alone, `cargo metadata` those of
/// the workspace.
fn names(build: &Build, host: &str) -> Result<BTreeSet<(String, String)>> {
    let mut tree = command("cargo");
    tree.args(["tree", "--locked", "--edges", "normal,no-proc-macro", "--target", host]);
    tree.args(["--prefix", "none", "--format", "{p}"]);
    tree.args(build.packages.iter().flat_map(|package| ["--package", package]));
    if !build.features.is_empty() {
        tree.arg("--features").arg(build.features.join(","));
    }
    let listed = output(&mut tree)?;
    let names = listed.lines().filter_map(|line| {
        let mut words = line.split(' ');
        Some((words.next()?.to_owned(), words.next()?.strip_prefix('v')?.to_owned()))
    });
    Ok(names.collect())
}

/// Returns the checksums of `Cargo.lock` by name and version.
fn checksums() -> Result<BTreeMap<(String, String), String>> {
    let lock: toml::Table =
        crate::inputs::text("Cargo.lock")?.parse().map_err(|error| format!("Cargo.lock: {error}"))?;
    let packages = lock.get("package").and_then(toml::Value::as_array).into_iter().flatten();
    let found = packages.filter_map(|package| {
        let of = |key: &str| package.get(key)?.as_str().map(str::to_owned);
        Some(((of("name")?, of("version")?), of("checksum")?))
    });
    Ok(found.collect())
}

fn text(value: &Value) -> String {
    value.as_str().unwrap_or_default().to_owned()
}
