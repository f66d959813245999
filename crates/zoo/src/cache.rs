//! The cache: one folder, shared by processes, whose complete files are never modified.
//!
//! ```text
//! blobs/<sha256>                     a checked file of a source
//! parts/<sha256>                     an incomplete download, which resumes
//! items/<learner>/<variant>-<hash>/  a finished container or sample
//! locks/, work/                      locks and temporary folders of processes
//! ```
//! Files are written to `work/` or `parts/` and renamed when they are complete.

use std::fs::{self, File};
use std::io::{BufReader, Write};
use std::path::{Path, PathBuf};

use opendr_engine::model::Sha256;
use opendr_engine::{Error, Progress, Result, ResultExt};

use crate::card::CardFile;
use crate::lock::Lock;
use crate::work_folder::WorkFolder;

#[derive(Debug, Clone)]
pub(crate) struct Cache {
    root: PathBuf,
}

impl Cache {
    pub(crate) fn new(root: PathBuf) -> Self {
        Self { root }
    }

    /// Returns the folder of a finished item; `recipe` is the hash of its contents.
    pub(crate) fn item(&self, learner: &str, variant: &str, recipe: &Sha256) -> PathBuf {
        let recipe = recipe.to_string();
        self.root.join("items").join(learner).join(format!("{variant}-{}", &recipe[..12]))
    }

    /// Returns whether the complete file is in the cache; its checksum was verified at the download.
    pub(crate) fn has(&self, file: &CardFile) -> bool {
        fs::metadata(self.blob(&file.sha256)).is_ok_and(|found| found.len() == file.size)
    }

    /// Returns the file's bytes. A damaged file is removed, so that it is downloaded again.
    pub(crate) fn read(&self, file: &CardFile) -> Result<Vec<u8>> {
        let path = self.blob(&file.sha256);
        let bytes = fs::read(&path).context(|| path.display().to_string())?;
        file.sha256.check(&file.name, &bytes).inspect_err(|_| {
            let _ = fs::remove_file(&path);
        })?;
        Ok(bytes)
    }

    /// Adds a file, by way of a work folder.
    pub(crate) fn insert(&self, file: &CardFile, bytes: &[u8], work: &WorkFolder) -> Result<()> {
        file.sha256.check(&file.name, bytes)?;
        let path = work.path().join("blob");
        let mut written = File::create(&path).context(|| path.display().to_string())?;
        written.write_all(bytes).and_then(|()| written.sync_all()).context(|| path.display().to_string())?;
        self.adopt(&path, &file.sha256)
    }

    /// Adds a finished download if its size and checksum are right; else removes it.
    pub(crate) fn adopt_part(&self, file: &CardFile) -> Result<()> {
        let part = self.part(&file.sha256);
        let reader = BufReader::new(File::open(&part).context(|| part.display().to_string())?);
        let (found, size) = Sha256::of_reader(reader).context(|| part.display().to_string())?;
        if size != file.size || found != file.sha256 {
            let _ = fs::remove_file(&part);
            file.sha256.check_equal(&file.name, &found)?;
            return Err(Error::integrity(format!("{} has {size} bytes instead of {}", file.name, file.size)));
        }
        self.adopt(&part, &file.sha256)
    }

    fn adopt(&self, path: &Path, sha256: &Sha256) -> Result<()> {
        let blob = self.blob(sha256);
        fs::create_dir_all(self.root.join("blobs")).context(|| self.root.display().to_string())?;
        fs::rename(path, &blob).context(|| blob.display().to_string())
    }

    fn blob(&self, sha256: &Sha256) -> PathBuf {
        self.root.join("blobs").join(sha256.to_string())
    }

    /// Returns the path of the incomplete download of a file.
    pub(crate) fn part(&self, sha256: &Sha256) -> PathBuf {
        self.root.join("parts").join(sha256.to_string())
    }

    /// Waits for the lock `key` for the download of `what`.
    pub(crate) fn lock(&self, key: &str, what: &str, progress: &dyn Progress) -> Result<Lock> {
        let name: String = key.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '_' }).collect();
        Lock::acquire(&self.root.join("locks").join(format!("{name}.lock")), what, progress)
    }

    /// Creates a temporary folder on the disk of the cache.
    pub(crate) fn work(&self, progress: &dyn Progress) -> Result<WorkFolder> {
        WorkFolder::new(&self.root.join("work"), progress)
    }
}
