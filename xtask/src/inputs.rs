//! Hashes of the inputs of checks: files of the tree, built programs, tools, environment.

use std::collections::BTreeMap;
use std::fs::{self, File};
use std::hash::{DefaultHasher, Hash, Hasher};
use std::io::Read;
use std::path::{Path, PathBuf};
use std::time::UNIX_EPOCH;

use crate::shell::{Result, command, output, root};

/// Prefixes of environment variables that affect builds or tests.
const VARIABLES: [&str; 7] =
    ["OPENDR_", "ORT_", "RUSTFLAGS", "RUSTDOCFLAGS", "CARGO_BUILD_", "CARGO_PROFILE_", "PYTHONPATH"];

/// The files of the working tree, tracked or untracked, without ignored ones, and the inputs common to all checks.
pub struct Tree {
    files: BTreeMap<String, u64>,
    machine: u64,
}

impl Tree {
    /// Reads the tree; `None` outside a git repository (an unpacked archive), so that no check is skipped.
    pub fn read(data: Option<&Path>) -> Option<Self> {
        let hashes = files().ok()?.into_iter().filter_map(|name| {
            let hash = of_file(&root().join(&name)).ok()?;
            Some((name, hash))
        });
        Some(Self { files: hashes.collect(), machine: machine(data).ok()? })
    }

    /// Returns the hash of the files whose path matches `wanted`, and of `others`.
    pub fn of(&self, wanted: impl Fn(&str) -> bool, others: &[u64]) -> u64 {
        let mut hasher = DefaultHasher::new();
        self.machine.hash(&mut hasher);
        for (name, hash) in self.files.iter().filter(|(name, _)| wanted(name)) {
            (name, hash).hash(&mut hasher);
        }
        others.hash(&mut hasher);
        hasher.finish()
    }
}

/// Returns the paths of the files of the working tree, tracked or untracked, without ignored ones.
pub fn files() -> Result<Vec<String>> {
    let listed =
        output(command("git").args(["ls-files", "-z", "--cached", "--others", "--exclude-standard"]))?;
    // A deleted file may still be in the index.
    let files = listed.split('\0').filter(|name| !name.is_empty() && root().join(name).is_file());
    Ok(files.map(str::to_owned).collect())
}

/// Returns the text of a file of the repository.
pub fn text(file: &str) -> Result<String> {
    fs::read_to_string(root().join(file)).map_err(|error| format!("{file}: {error}"))
}

/// Returns the hash of a file's content.
pub fn of_file(path: &Path) -> Result<u64> {
    let failed = |error: std::io::Error| format!("{}: {error}", path.display());
    let mut file = File::open(path).map_err(failed)?;
    let mut hasher = DefaultHasher::new();
    let mut buffer = vec![0; 1 << 20];
    loop {
        match file.read(&mut buffer).map_err(failed)? {
            0 => return Ok(hasher.finish()),
            read => hasher.write(&buffer[..read]),
        }
    }
}

/// Returns the hash of compiler, test runner, interpreter, environment, and of names, sizes and times of the test data.
fn machine(data: Option<&Path>) -> Result<u64> {
    let mut hasher = DefaultHasher::new();
    for (program, argument) in [("rustc", "-vV"), ("cargo", "-V"), ("python3", "-VV")] {
        output(command(program).arg(argument))?.hash(&mut hasher);
    }
    let variables: BTreeMap<_, _> = std::env::vars_os()
        .filter(|(name, _)| VARIABLES.iter().any(|prefix| name.to_string_lossy().starts_with(prefix)))
        .collect();
    variables.hash(&mut hasher);
    if let Some(data) = data {
        listing(data)?.hash(&mut hasher);
    }
    Ok(hasher.finish())
}

/// Returns name, size and modification time of every file below a folder.
fn listing(folder: &Path) -> Result<Vec<(PathBuf, u64, u64)>> {
    let mut found = Vec::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(folder) = folders.pop() {
        let failed = |error: std::io::Error| format!("{}: {error}", folder.display());
        for entry in fs::read_dir(&folder).map_err(failed)? {
            let path = entry.map_err(failed)?.path();
            let about = fs::metadata(&path).map_err(|error| format!("{}: {error}", path.display()))?;
            if about.is_dir() {
                folders.push(path);
            } else {
                let changed = about.modified().ok().and_then(|time| time.duration_since(UNIX_EPOCH).ok());
                found.push((path, about.len(), changed.map_or(0, |time| time.as_secs())));
            }
        }
    }
    found.sort();
    Ok(found)
}
