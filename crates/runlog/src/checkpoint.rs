//! A checkpoint: a folder of files with a manifest of their sizes and hashes.

use std::fs::{self, File};
use std::io::Read;
use std::path::{Path, PathBuf};

use opendr_engine::model::{Sha256, member_path};
use opendr_engine::{Error, JsonFormat, Result, ResultExt};
use serde::{Deserialize, Serialize};

use crate::atomic_file::{sync_folder, write_error, write_synced};

const MANIFEST: &str = "checkpoint.json";
const FORMAT: JsonFormat = JsonFormat::new("manifest of a checkpoint", 1);
const MAX_MANIFEST_BYTES: u64 = 1 << 20;
/// Maximum size of a file.
const MAX_FILE_BYTES: u64 = 16 << 30;

/// A verified checkpoint.
#[derive(Debug, Clone)]
pub struct Checkpoint {
    /// Step after which it was written.
    pub step: u64,
    /// Newer checkpoints that were skipped because they are damaged, with the reason, one per line.
    pub skipped: Vec<String>,
    path: PathBuf,
    manifest: Manifest,
}

#[derive(Debug, Clone, Serialize, Deserialize)]
struct Manifest {
    step: u64,
    files: Vec<Entry>,
}

#[derive(Debug, Clone, Serialize, Deserialize)]
struct Entry {
    name: String,
    size: u64,
    sha256: Sha256,
}

impl Checkpoint {
    /// Returns its folder.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Returns the names of its files.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.manifest.files.iter().map(|entry| entry.name.as_str())
    }

    /// Returns the bytes of a file, after a check of its size and SHA-256.
    ///
    /// # Errors
    /// `NotFound` when it has no such file, `Integrity` when the file is damaged.
    pub fn file(&self, name: &str) -> Result<Vec<u8>> {
        let entry = self.manifest.files.iter().find(|entry| entry.name == name).ok_or_else(|| {
            let names: Vec<_> = self.names().collect();
            Error::not_found(format!(
                "the checkpoint {} has no file {name:?}; it has {}",
                self.path.display(),
                names.join(", ")
            ))
        })?;
        entry.read(&self.path).context(|| format!("reading the checkpoint {}", self.path.display()))
    }

    /// Writes the files into a new folder and syncs them.
    pub(crate) fn write(folder: &Path, step: u64, files: &[(&str, &[u8])]) -> Result<()> {
        let mut entries = Vec::<Entry>::new();
        fs::create_dir(folder).map_err(|error| write_error(folder, error))?;
        for (name, bytes) in files {
            let path = folder.join(member_path(name)?);
            let taken = |entry: &Entry| entry.name.eq_ignore_ascii_case(name);
            if name.eq_ignore_ascii_case(MANIFEST) || entries.iter().any(taken) {
                return Err(Error::invalid_param(format!("the checkpoint already has a file {name:?}")));
            }
            if let Some(parent) = path.parent().filter(|parent| *parent != folder) {
                fs::create_dir_all(parent).map_err(|error| write_error(parent, error))?;
            }
            write_whole(&path, bytes)?;
            let (name, size) = ((*name).to_owned(), bytes.len() as u64);
            entries.push(Entry { name, size, sha256: Sha256::of(bytes) });
        }
        let json = FORMAT.to_pretty_json(&Manifest { step, files: entries })?;
        write_whole(&folder.join(MANIFEST), json.as_bytes())
    }

    /// Opens the checkpoint in a folder and verifies all its files.
    ///
    /// # Errors
    /// `NotFound`, `Format` or `Integrity` when it is incomplete or damaged.
    pub(crate) fn open(path: PathBuf) -> Result<Self> {
        let manifest_path = path.join(MANIFEST);
        let mut json = Vec::new();
        let file = File::open(&manifest_path).context(|| manifest_path.display().to_string())?;
        file.take(MAX_MANIFEST_BYTES).read_to_end(&mut json)?;
        let manifest: Manifest = FORMAT.read(&json).context(|| manifest_path.display().to_string())?;
        manifest.files.iter().try_for_each(|entry| entry.check(&path))?;
        Ok(Self { step: manifest.step, skipped: Vec::new(), path, manifest })
    }
}

fn write_whole(path: &Path, bytes: &[u8]) -> Result<()> {
    write_synced(path, bytes).and_then(|()| sync_folder(path)).map_err(|error| write_error(path, error))
}

impl Entry {
    fn open(&self, folder: &Path) -> Result<File> {
        let path = folder.join(member_path(&self.name)?);
        let file = File::open(&path).context(|| path.display().to_string())?;
        let (found, size) = (file.metadata()?.len(), self.size);
        if found == size && size <= MAX_FILE_BYTES {
            return Ok(file);
        }
        Err(Error::integrity(format!(
            "{} has {found} bytes instead of {size}, it is damaged",
            path.display()
        )))
    }

    fn check(&self, folder: &Path) -> Result<()> {
        let (found, _) = Sha256::of_reader(self.open(folder)?)?;
        self.sha256.check_equal(&self.name, &found)
    }

    fn read(&self, folder: &Path) -> Result<Vec<u8>> {
        let mut bytes = Vec::new();
        self.open(folder)?.take(self.size).read_to_end(&mut bytes)?;
        self.sha256.check(&self.name, &bytes)?;
        Ok(bytes)
    }
}
