//! `cargo xtask reproducible PACKAGE`: builds a package in two folders and compares the files.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use serde_json::Value;
use sha2::{Digest, Sha256};

use crate::shell::{Result, command, output, target};
use crate::source_date::SourceDate;

/// Names of the folders, of different length: a path that is kept in a file changes it.
const FOLDERS: [&str; 2] = ["a", "another-folder"];

/// Path that the files have instead of that of the folder.
const SOURCES: &str = "/usr/src/opendr";

/// Builds the last commit twice, in the profile `profile`. Fails if a file of the package differs.
pub fn run(package: &str, profile: &str) -> Result<()> {
    let date = SourceDate::get()?;
    // A commit made between the builds is in neither.
    let commit = output(command("git").args(["rev-parse", "HEAD"]))?;
    let commit = commit.trim();
    let builds = FOLDERS
        .iter()
        .map(|folder| {
            build(
                &std::path::absolute(target().join("reproducible").join(folder))
                    .map_err(|error| error.to_string())?,
                package,
                profile,
                date,
                commit,
            )
        })
        .collect::<Result<Vec<_>>>()?;
    let [first, second] = &builds[..] else { return Err("there are two builds".to_owned()) };
    let mut differing = Vec::new();
    for (name, hash) in first {
        let is_equal = second.get(name) == Some(hash);
        println!("{} {hash}  {name}", if is_equal { "same     " } else { "different" });
        if !is_equal {
            differing.push(name.as_str());
        }
    }
    if first.is_empty() || first.len() != second.len() {
        return Err(format!("{package}: {} files in one build, {} in the other", first.len(), second.len()));
    }
    if differing.is_empty() {
        Ok(())
    } else {
        Err(format!("{package}: two builds differ in {}", differing.join(", ")))
    }
}

/// Builds the sources of the last commit in a folder and returns the hashes of the files by their names.
fn build(
    folder: &Path,
    package: &str,
    profile: &str,
    date: SourceDate,
    commit: &str,
) -> Result<BTreeMap<String, String>> {
    // A missing folder is no error.
    fs::remove_dir_all(folder).ok();
    let sources = folder.join("sources");
    fs::create_dir_all(&sources).map_err(|error| format!("{}: {error}", sources.display()))?;
    let archive = folder.join("sources.tar");
    output(command("git").args(["archive", "--format=tar", commit, "-o"]).arg(&archive))?;
    output(command("tar").arg("-xf").arg(&archive).arg("-C").arg(&sources))?;
    let registry = std::env::var_os("CARGO_HOME")
        .map(PathBuf::from)
        .or_else(|| Some(PathBuf::from(std::env::var_os("HOME")?).join(".cargo")));
    // The folder of the build is below it: build scripts write sources there, whose paths are kept too.
    let mut flags = vec![format!("--remap-path-prefix={}={SOURCES}", folder.display())];
    flags.extend(
        registry.map(|registry| format!("--remap-path-prefix={}=/usr/src/cargo", registry.display())),
    );
    println!("=== {package} in {}", folder.display());
    let mut cargo = Command::new("cargo");
    cargo.current_dir(&sources).args(["build", "--locked", "--profile", profile, "--package", package]);
    cargo
        .args(["--message-format", "json-render-diagnostics"])
        .arg("--target-dir")
        .arg(folder.join("target"));
    cargo
        .env("SOURCE_DATE_EPOCH", date.seconds().to_string())
        .env("CARGO_ENCODED_RUSTFLAGS", flags.join("\u{1f}"));
    let done =
        cargo.stderr(Stdio::inherit()).output().map_err(|error| format!("cannot run cargo: {error}"))?;
    if !done.status.success() {
        return Err(format!("the build in {} failed ({})", folder.display(), done.status));
    }
    hashes(&String::from_utf8_lossy(&done.stdout), &sources)
}

/// Returns the SHA-256 of the programs and libraries for users by their names, from cargo's messages about the sources.
fn hashes(messages: &str, sources: &Path) -> Result<BTreeMap<String, String>> {
    let mut hashes = BTreeMap::new();
    for message in messages.lines().filter_map(|line| serde_json::from_str::<Value>(line).ok()) {
        let is_ours =
            message["manifest_path"].as_str().is_some_and(|path| Path::new(path).starts_with(sources));
        if message["reason"] != "compiler-artifact" || !is_ours {
            continue;
        }
        let kinds: Vec<_> =
            message["target"]["kind"].as_array().into_iter().flatten().filter_map(Value::as_str).collect();
        if !kinds.iter().any(|kind| ["bin", "cdylib", "staticlib"].contains(kind)) {
            continue;
        }
        let files = message["filenames"].as_array().into_iter().flatten().filter_map(Value::as_str);
        for file in files.chain(message["executable"].as_str()).filter(|file| !file.ends_with(".rlib")) {
            let bytes = fs::read(file).map_err(|error| format!("{file}: {error}"))?;
            let name = Path::new(file).file_name().unwrap_or_default().to_string_lossy().into_owned();
            hashes.insert(name, Sha256::digest(bytes).iter().map(|byte| format!("{byte:02x}")).collect());
        }
    }
    Ok(hashes)
}
