//! The zoo: finds, downloads and caches.

use std::fs;
use std::path::{Path, PathBuf};

use opendr_engine::model::{Manifest, Model, ModelWriter};
use opendr_engine::{Error, ErrorKind, Progress, Result, ResultExt};

use crate::cache::Cache;
use crate::card::{Card, ItemKind};
use crate::embedded::embedded_cards;
use crate::fetch::Fetch;
use crate::http::Http;
use crate::import::imported;
use crate::item::Item;
use crate::options::ZooOptions;
use crate::repository::{Repository, card_files, copy_container};
use crate::stopped;
use crate::tried::Tried;

/// The models and samples that the cards name, and the cache that holds those that were got.
///
/// ```no_run
/// # fn main() -> opendr_engine::Result<()> {
/// use opendr_engine::{Model, Silent};
/// use opendr_zoo::{Zoo, ZooOptions};
///
/// let zoo = Zoo::new(ZooOptions::from_env()?)?;
/// let model = Model::open(zoo.get("nanodet/coco_416", &Silent)?)?;
/// # Ok(()) }
/// ```
#[derive(Debug)]
pub struct Zoo {
    cards: Vec<Card>,
    offline: bool,
    repository: Option<Repository>,
    cache: Cache,
    http: Http,
}

impl Zoo {
    /// The zoo of the built-in cards.
    ///
    /// # Errors
    /// None that the tests let pass.
    pub fn new(options: ZooOptions) -> Result<Self> {
        Ok(Self::with_cards(options, embedded_cards()?))
    }

    /// A zoo of these cards only.
    pub fn with_cards(options: ZooOptions, cards: Vec<Card>) -> Self {
        Self {
            cards,
            offline: options.offline,
            repository: options.repository.as_deref().map(Repository::new),
            cache: Cache::new(options.cache),
            http: Http::new(options.timeout, options.retry_pause),
        }
    }

    /// The cards.
    pub fn cards(&self) -> &[Card] {
        &self.cards
    }

    /// Every item of every card.
    pub fn items(&self) -> impl Iterator<Item = Item<'_>> {
        self.cards.iter().flat_map(|card| card.variants.iter().map(move |variant| Item { card, variant }))
    }

    /// The item called `learner/variant`, or the default variant of `learner`.
    ///
    /// # Errors
    /// `NotFound`, naming those there are.
    pub fn find(&self, spec: &str) -> Result<Item<'_>> {
        let (learner, variant) = spec.split_once('/').map_or((spec, None), |(name, rest)| (name, Some(rest)));
        let card = self.cards.iter().find(|card| card.learner == learner).ok_or_else(|| {
            let names: Vec<_> = self.cards.iter().map(|card| card.learner.as_str()).collect();
            Error::not_found(format!("the zoo has no {learner:?}; it has {}", names.join(", ")))
        })?;
        Ok(Item { card, variant: card.variant(variant)? })
    }

    /// The item's container or sample file when it is on this machine: a container of the repository's folder, or of
    /// the cache. No network, no checksum ([`Model::file`] checks what it reads).
    pub fn cached(&self, spec: &str) -> Option<PathBuf> {
        self.ready(&self.find(spec).ok()?)
    }

    /// The item's container or sample file, downloaded when it is not there yet.
    ///
    /// # Errors
    /// As [`Zoo::download`].
    pub fn get(&self, spec: &str, progress: &dyn Progress) -> Result<PathBuf> {
        let item = self.find(spec)?;
        match self.ready(&item) {
            Some(path) => Ok(path),
            None => self.fetch(&item, progress),
        }
    }

    /// Sees to it that the item is there, every byte of it checked; gets it (again) where it is not. With `to`, a copy
    /// is put into that folder as `<learner>/<variant>`, which makes the folder a repository of models. The answer is
    /// the container's folder, or a sample's file.
    ///
    /// # Errors
    /// `NotFound` when there is no such item, else one that tells what was tried and why each source failed: `Integrity`
    /// when a file was not the one of the card, `Network` when a source could not be reached.
    pub fn download(&self, spec: &str, to: Option<&Path>, progress: &dyn Progress) -> Result<PathBuf> {
        let item = self.find(spec)?;
        let mut path = self.ready(&item);
        if let Some(Err(error)) = path.as_deref().map(|path| check_whole(&item, path)) {
            progress.note(&format!("{error}: getting it again"));
            path = None;
            fs::remove_dir_all(self.folder(&item)?).or_else(absent_is_fine)?;
        }
        let path = path.map_or_else(|| self.fetch(&item, progress), Ok)?;
        match to {
            None => Ok(path),
            Some(folder) => copy_out(&item, &path, folder),
        }
    }

    /// The file of the sample called `name`, downloaded when it is not there yet.
    ///
    /// # Errors
    /// As [`Zoo::download`].
    pub fn sample(&self, name: &str, progress: &dyn Progress) -> Result<PathBuf> {
        let samples = self.items().filter(|item| item.card.kind == ItemKind::Sample);
        let mut names = Vec::new();
        for item in samples {
            if item.variant.name == name {
                return self.get(&item.to_string(), progress);
            }
            names.push(item.variant.name.as_str());
        }
        Err(Error::not_found(format!("the zoo has no sample {name:?}; it has {}", names.join(", "))))
    }

    fn folder(&self, item: &Item<'_>) -> Result<PathBuf> {
        Ok(self.cache.item(&item.card.learner, &item.variant.name, &item.recipe()?))
    }

    /// Where the item is, when all of its files are there with the right sizes.
    fn ready(&self, item: &Item<'_>) -> Option<PathBuf> {
        if let Some(path) = self.repository.as_ref().and_then(|repository| repository.container(item)) {
            return Some(path);
        }
        let folder = self.folder(item).ok()?;
        let has = |name: &str, size: u64| {
            fs::metadata(folder.join(name)).is_ok_and(|found| found.is_file() && found.len() == size)
        };
        match item.card.kind {
            ItemKind::Sample => {
                let file = item.variant.files.first()?;
                has(&file.name, file.size).then(|| folder.join(&file.name))
            }
            ItemKind::Model => {
                let files = card_files(Model::open(&folder).ok()?.manifest()).ok()?;
                files.iter().all(|file| has(&file.name, file.size)).then_some(folder)
            }
        }
    }

    fn fetch(&self, item: &Item<'_>, progress: &dyn Progress) -> Result<PathBuf> {
        let _turn = self.cache.lock(&item.to_string(), &item.to_string(), progress)?;
        if let Some(path) = self.ready(item) {
            return Ok(path);
        }
        let fetch = Fetch {
            cards: &self.cards,
            cache: &self.cache,
            http: &self.http,
            repository: self.repository.as_ref(),
            offline: self.offline,
            progress,
        };
        let mut tried = Tried::default();
        match fetch.container(item) {
            Ok(None) => {}
            Ok(Some(manifest)) => return self.assemble_container(item, manifest),
            Err(error) => tried.add("OPENDR_MODEL_REPOSITORY", error),
        }
        if let Some(path) = self.assemble_from_cache(item, progress)? {
            return Ok(path);
        }
        for source in &item.variant.sources {
            match fetch.files(item, source) {
                Ok(()) => match self.assemble_from_cache(item, progress)? {
                    Some(path) => return Ok(path),
                    None => {
                        tried.add(source.to_string(), Error::integrity("the files do not stay whole on disk"))
                    }
                },
                Err(_) if progress.stopped() => return Err(stopped()),
                Err(error) => tried.add(source.to_string(), error),
            }
        }
        Err(tried.error(item))
    }

    /// Makes the item from the cache's files; `None` when one is missing or was damaged since it came.
    fn assemble_from_cache(&self, item: &Item<'_>, progress: &dyn Progress) -> Result<Option<PathBuf>> {
        if !item.variant.files.iter().all(|file| self.cache.has(file)) {
            return Ok(None);
        }
        let files: Result<Vec<_>> = item.variant.files.iter().map(|file| self.cache.read(file)).collect();
        let files = match files {
            Ok(files) => files,
            Err(error) if matches!(error.kind(), ErrorKind::Integrity | ErrorKind::NotFound) => {
                return Ok(None);
            }
            Err(error) => return Err(error),
        };
        let assembled = match item.card.kind {
            ItemKind::Sample => self.assemble_sample(item, &files, progress),
            ItemKind::Model => self.assemble_model(item, &files, progress),
        };
        assembled.map(Some).context(|| format!("making {item}"))
    }

    fn assemble_model(&self, item: &Item<'_>, files: &[Vec<u8>], progress: &dyn Progress) -> Result<PathBuf> {
        let mut writer = ModelWriter::new(self.folder(item)?, item.manifest())?;
        if let Some(import) = &item.variant.import {
            progress.note(&format!("converting {item} to ONNX"));
            let (name, bytes) = imported(import, files)?;
            writer.add(&name, &bytes)?;
        } else {
            for (file, bytes) in item.variant.files.iter().zip(files) {
                writer.add(&file.name, bytes)?;
            }
        }
        Ok(writer.finish()?.path().to_owned())
    }

    fn assemble_container(&self, item: &Item<'_>, manifest: Manifest) -> Result<PathBuf> {
        let files = card_files(&manifest)?;
        let mut writer = ModelWriter::new(self.folder(item)?, manifest)?;
        for file in &files {
            writer.add(&file.name, &self.cache.read(file)?)?;
        }
        Ok(writer.finish()?.path().to_owned())
    }

    fn assemble_sample(
        &self,
        item: &Item<'_>,
        files: &[Vec<u8>],
        progress: &dyn Progress,
    ) -> Result<PathBuf> {
        let (Some(file), Some(bytes)) = (item.variant.files.first(), files.first()) else {
            return Err(Error::format("a sample without a file"));
        };
        let folder = self.folder(item)?;
        let work = self.cache.work(progress)?;
        let made = work.folder("sample")?;
        fs::write(made.join(&file.name), bytes)?;
        fs::remove_dir_all(&folder).or_else(absent_is_fine)?;
        if let Some(parent) = folder.parent() {
            fs::create_dir_all(parent)?;
        }
        fs::rename(&made, &folder).context(|| folder.display().to_string())?;
        Ok(folder.join(&file.name))
    }
}

fn absent_is_fine(error: std::io::Error) -> std::io::Result<()> {
    if error.kind() == std::io::ErrorKind::NotFound { Ok(()) } else { Err(error) }
}

/// Reads every byte and checks it.
fn check_whole(item: &Item<'_>, path: &Path) -> Result<()> {
    if item.card.kind == ItemKind::Sample {
        let bytes = fs::read(path)?;
        return item.variant.files.iter().try_for_each(|file| file.sha256.check(&file.name, &bytes));
    }
    let model = Model::open(path)?;
    model.manifest().files.iter().try_for_each(|file| model.file(&file.name).map(drop))
}

fn copy_out(item: &Item<'_>, path: &Path, folder: &Path) -> Result<PathBuf> {
    let target = folder.join(&item.card.learner).join(&item.variant.name);
    if item.card.kind == ItemKind::Model {
        return copy_container(&Model::open(path)?, &target);
    }
    let file = target.join(path.file_name().unwrap_or_default());
    fs::create_dir_all(&target)
        .and_then(|()| fs::copy(path, &file))
        .context(|| file.display().to_string())?;
    Ok(file)
}
