//! The cache: one folder, shared by processes, whose complete parts are never written to again.
//!
//! ```text
//! blobs/<sha256>                     a file as its source has it, checked
//! parts/<sha256>                     a download that goes on where it stopped
//! items/<learner>/<variant>-<hash>/  a container or sample, ready
//! locks/, work/                      who is at what
//! ```
//! Whatever is written goes to `work/` or `parts/` first and is renamed when it is complete.

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

    /// Where an item's folder is when it is ready; `recipe` stands for all that went into it.
    pub(crate) fn item(&self, learner: &str, variant: &str, recipe: &Sha256) -> PathBuf {
        let recipe = recipe.to_string();
        self.root.join("items").join(learner).join(format!("{variant}-{}", &recipe[..12]))
    }

    /// Whether the file is there in full; its checksum was right when it came.
    pub(crate) fn has(&self, file: &CardFile) -> bool {
        fs::metadata(self.blob(&file.sha256)).is_ok_and(|found| found.len() == file.size)
    }

    /// The file's bytes. One that was damaged since is removed, so that it is got again.
    pub(crate) fn read(&self, file: &CardFile) -> Result<Vec<u8>> {
        let path = self.blob(&file.sha256);
        let bytes = fs::read(&path).context(|| path.display().to_string())?;
        file.sha256.check(&file.name, &bytes).inspect_err(|_| {
            let _ = fs::remove_file(&path);
        })?;
        Ok(bytes)
    }

    /// Takes a file in, by way of a work folder.
    pub(crate) fn insert(&self, file: &CardFile, bytes: &[u8], work: &WorkFolder) -> Result<()> {
        file.sha256.check(&file.name, bytes)?;
        let path = work.path().join("blob");
        let mut written = File::create(&path).context(|| path.display().to_string())?;
        written.write_all(bytes).and_then(|()| written.sync_all()).context(|| path.display().to_string())?;
        self.adopt(&path, &file.sha256)
    }

    /// Takes a downloaded part in when it is the file; else removes it.
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

    /// Where the unfinished download of a file lies.
    pub(crate) fn part(&self, sha256: &Sha256) -> PathBuf {
        self.root.join("parts").join(sha256.to_string())
    }

    /// Waits for the turn to get `what`; `key` names the lock.
    pub(crate) fn lock(&self, key: &str, what: &str, progress: &dyn Progress) -> Result<Lock> {
        let name: String = key.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '_' }).collect();
        Lock::acquire(&self.root.join("locks").join(format!("{name}.lock")), what, progress)
    }

    /// A new folder for unfinished work, on the cache's own disk.
    pub(crate) fn work(&self, progress: &dyn Progress) -> Result<WorkFolder> {
        WorkFolder::new(&self.root.join("work"), progress)
    }
}
