//! Assembly of items from files of the cache.

use std::path::{Path, PathBuf};
use std::{fs, io};

use opendr_engine::model::{Manifest, Model, ModelWriter};
use opendr_engine::{Error, ErrorKind, Progress, Result, ResultExt};

use crate::cache::Cache;
use crate::card::{CardFile, ItemKind};
use crate::import::imported;
use crate::item::Item;
use crate::repository::card_files;

/// Assembly of one item.
pub(crate) struct Assembly<'a> {
    pub(crate) item: &'a Item<'a>,
    pub(crate) cache: &'a Cache,
    pub(crate) progress: &'a dyn Progress,
}

impl Assembly<'_> {
    /// Makes the item from the card's files and `parts`; returns `None` if a file is missing or was damaged after its download.
    pub(crate) fn of_files(&self, folder: &Path, parts: &[(&str, Model)]) -> Result<Option<PathBuf>> {
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
            ItemKind::Model => self.model(folder, &bytes, parts),
        };
        made.map(Some).context(|| format!("making {}", self.item))
    }

    /// Makes the item from a repository's container, whose files are in the cache.
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

    fn model(&self, folder: &Path, files: &[Vec<u8>], parts: &[(&str, Model)]) -> Result<PathBuf> {
        let work = self.cache.work(self.progress)?;
        let made = work.path().join("item");
        let mut writer = ModelWriter::new(&made, self.item.manifest())?;
        let own = &self.item.variant.files;
        if self.item.variant.import.is_empty() {
            for (file, bytes) in own.iter().zip(files) {
                writer.add(&file.name, bytes)?;
            }
        } else {
            self.progress.note(&format!("converting {} to ONNX", self.item));
        }
        for import in &self.item.variant.import {
            let bytes_of = |file: &'_ CardFile| own.iter().position(|other| other.name == file.name);
            let named = import.files_of(own).into_iter().filter_map(bytes_of);
            let named: Vec<_> = named.map(|at| (own[at].name.as_str(), files[at].as_slice())).collect();
            for (name, bytes) in imported(import, &named)? {
                writer.add(name, &bytes)?;
            }
        }
        for (name, part) in parts {
            writer.add_part(name, part)?;
        }
        writer.finish()?;
        place(&made, folder)?;
        Ok(folder.to_owned())
    }

    fn sample(&self, folder: &Path, files: &[Vec<u8>]) -> Result<PathBuf> {
        let (Some(file), Some(bytes)) = (self.item.variant.files.first(), files.first()) else {
            return Err(Error::format("the sample has no file"));
        };
        let work = self.cache.work(self.progress)?;
        let made = work.folder("item")?;
        fs::write(made.join(&file.name), bytes)?;
        place(&made, folder)?;
        Ok(folder.join(&file.name))
    }
}

/// Moves a finished folder to its place in the cache, where at most an incomplete one exists.
fn place(made: &Path, folder: &Path) -> Result<()> {
    fs::remove_dir_all(folder).or_else(absent_is_fine).context(|| folder.display().to_string())?;
    if let Some(parent) = folder.parent() {
        fs::create_dir_all(parent).context(|| parent.display().to_string())?;
    }
    fs::rename(made, folder).context(|| folder.display().to_string())
}

/// Treats the removal of a missing file as success.
pub(crate) fn absent_is_fine(error: io::Error) -> io::Result<()> {
    if error.kind() == io::ErrorKind::NotFound { Ok(()) } else { Err(error) }
}
