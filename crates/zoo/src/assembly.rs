//! Makes the finished item from files of the cache.

use std::path::{Path, PathBuf};
use std::{fs, io};

use opendr_engine::model::{Manifest, ModelWriter};
use opendr_engine::{Error, ErrorKind, Progress, Result, ResultExt};

use crate::cache::Cache;
use crate::card::ItemKind;
use crate::import::imported;
use crate::item::Item;
use crate::repository::card_files;

/// What it takes to make an item.
pub(crate) struct Assembly<'a> {
    pub(crate) item: &'a Item<'a>,
    pub(crate) cache: &'a Cache,
    pub(crate) progress: &'a dyn Progress,
}

impl Assembly<'_> {
    /// Makes it of the card's files; `None` when one is missing or was damaged since it came.
    pub(crate) fn of_files(&self, folder: &Path) -> Result<Option<PathBuf>> {
        let files = &self.item.variant.files;
        if !files.iter().all(|file| self.cache.has(file)) {
            return Ok(None);
        }
        let bytes: Result<Vec<_>> = files.iter().map(|file| self.cache.read(file)).collect();
        let bytes = match bytes {
            Ok(bytes) => bytes,
            Err(error) if matches!(error.kind(), ErrorKind::Integrity | ErrorKind::NotFound) => {
                return Ok(None);
            }
            Err(error) => return Err(error),
        };
        let made = match self.item.card.kind {
            ItemKind::Sample => self.sample(folder, &bytes),
            ItemKind::Model => self.model(folder, &bytes),
        };
        made.map(Some).context(|| format!("making {}", self.item))
    }

    /// Makes it of a repository's container, whose files are in the cache.
    pub(crate) fn of_container(&self, folder: &Path, manifest: Manifest) -> Result<PathBuf> {
        let files = card_files(&manifest)?;
        let work = self.cache.work(self.progress)?;
        let made = work.path().join("item");
        let mut writer = ModelWriter::new(&made, manifest)?;
        for file in &files {
            writer.add(&file.name, &self.cache.read(file)?)?;
        }
        writer.finish()?;
        place(&made, folder)?;
        Ok(folder.to_owned())
    }

    fn model(&self, folder: &Path, files: &[Vec<u8>]) -> Result<PathBuf> {
        let work = self.cache.work(self.progress)?;
        let made = work.path().join("item");
        let mut writer = ModelWriter::new(&made, self.item.manifest())?;
        if let Some(import) = &self.item.variant.import {
            self.progress.note(&format!("converting {} to ONNX", self.item));
            let names: Vec<&str> = self.item.variant.files.iter().map(|file| file.name.as_str()).collect();
            for (name, bytes) in imported(import, &names, files)? {
                writer.add(&name, &bytes)?;
            }
        } else {
            for (file, bytes) in self.item.variant.files.iter().zip(files) {
                writer.add(&file.name, bytes)?;
            }
        }
        writer.finish()?;
        place(&made, folder)?;
        Ok(folder.to_owned())
    }

    fn sample(&self, folder: &Path, files: &[Vec<u8>]) -> Result<PathBuf> {
        let (Some(file), Some(bytes)) = (self.item.variant.files.first(), files.first()) else {
            return Err(Error::format("a sample without a file"));
        };
        let work = self.cache.work(self.progress)?;
        let made = work.folder("item")?;
        fs::write(made.join(&file.name), bytes)?;
        place(&made, folder)?;
        Ok(folder.join(&file.name))
    }
}

/// Moves a finished folder to its place in the cache; what is there is not whole, else nothing would be made.
fn place(made: &Path, folder: &Path) -> Result<()> {
    fs::remove_dir_all(folder).or_else(absent_is_fine).context(|| folder.display().to_string())?;
    if let Some(parent) = folder.parent() {
        fs::create_dir_all(parent).context(|| parent.display().to_string())?;
    }
    fs::rename(made, folder).context(|| folder.display().to_string())
}

/// Turns the removal of what is not there into a success.
pub(crate) fn absent_is_fine(error: io::Error) -> io::Result<()> {
    if error.kind() == io::ErrorKind::NotFound { Ok(()) } else { Err(error) }
}
