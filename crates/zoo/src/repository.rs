//! The user's model repository: a folder or an address, which has priority over other sources.

use std::fs;
use std::path::{Path, PathBuf};

use opendr_engine::model::{MANIFEST_NAME, Manifest, Model, ModelFile, ModelWriter, member_path};
use opendr_engine::{Error, Progress, Result, ResultExt};

use crate::cache::Cache;
use crate::card::CardFile;
use crate::download::{address_below, download};
use crate::http::Http;
use crate::item::Item;
use crate::signature::{MAX_SIGNATURE_BYTES, RepositoryKey, SIGNATURE_NAME};

const MAX_MANIFEST_BYTES: u64 = 16 << 20;

#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Repository {
    Folder(PathBuf),
    Address(String),
}

impl Repository {
    pub(crate) fn new(text: &str) -> Self {
        if ["http://", "https://"].iter().any(|scheme| text.starts_with(scheme)) {
            Self::Address(text.to_owned())
        } else {
            Self::Folder(PathBuf::from(text))
        }
    }

    /// Returns the container of the item in a folder, if it is there.
    pub(crate) fn container(&self, item: &Item<'_>) -> Option<PathBuf> {
        let Self::Folder(folder) = self else { return None };
        let path = folder.join(item.place());
        path.join(MANIFEST_NAME).is_file().then_some(path)
    }

    /// Returns the manifest of the item's container at an address and downloads its files into the cache. With a key, its signature
    /// is verified first.
    pub(crate) fn fetch_container(
        &self,
        item: &Item<'_>,
        key: Option<&RepositoryKey>,
        http: &Http,
        cache: &Cache,
        progress: &dyn Progress,
    ) -> Result<Option<Manifest>> {
        let Self::Address(base) = self else { return Ok(None) };
        let base = address_below(base, &item.place());
        let address = address_below(&base, MANIFEST_NAME);
        let Some(json) = http.small(&address, MAX_MANIFEST_BYTES, progress)? else { return Ok(None) };
        if let Some(key) = key {
            let signature =
                http.small(&address_below(&base, SIGNATURE_NAME), MAX_SIGNATURE_BYTES, progress)?;
            key.verify(item, &json, signature.as_deref(), &address)?;
        }
        let manifest = Manifest::from_json(&json).context(|| address.clone())?;
        if manifest.learner != item.card.learner {
            return Err(Error::format(format!("{address} is a model of the learner {:?}", manifest.learner)));
        }
        for file in card_files(&manifest)? {
            download(http, cache, &address_below(&base, &file.name), &file, progress)?;
        }
        Ok(Some(manifest))
    }

    /// Adds the file at `place` to the cache.
    pub(crate) fn fetch_file(
        &self,
        place: &str,
        file: &CardFile,
        http: &Http,
        cache: &Cache,
        progress: &dyn Progress,
    ) -> Result<()> {
        let folder = match self {
            Self::Address(base) => {
                return download(http, cache, &address_below(base, place), file, progress);
            }
            Self::Folder(folder) => folder,
        };
        let path = folder.join(member_path(place)?);
        let size = fs::metadata(&path).context(|| path.display().to_string())?.len();
        if size != file.size {
            let text = format!("{} has {size} bytes instead of {}", path.display(), file.size);
            return Err(Error::integrity(text));
        }
        let bytes = fs::read(&path).context(|| path.display().to_string())?;
        cache.insert(file, &bytes, &cache.work(progress)?).context(|| path.display().to_string())
    }

    /// Returns the address of a repository on the network.
    pub(crate) fn address(&self) -> Option<&str> {
        match self {
            Self::Folder(_) => None,
            Self::Address(address) => Some(address),
        }
    }
}

/// Returns the files of a container as entries of a card.
pub(crate) fn card_files(manifest: &Manifest) -> Result<Vec<CardFile>> {
    let file = |file: &ModelFile| match (file.size, file.sha256) {
        (Some(size), Some(sha256)) => Ok(CardFile { name: file.name.clone(), size, sha256 }),
        _ => Err(Error::format(format!("{:?} has no size or no sha256 in {MANIFEST_NAME}", file.name))),
    };
    manifest.files.iter().map(file).collect()
}

/// Writes a copy of an opened container to `path` and verifies every file.
pub(crate) fn copy_container(model: &Model, path: &Path) -> Result<PathBuf> {
    let mut writer = ModelWriter::new(path, model.manifest().clone())?;
    for file in &model.manifest().files {
        writer.add(&file.name, &model.file(&file.name)?)?;
    }
    Ok(writer.finish()?.path().to_owned())
}
