//! The zoo: lookup, download and cache of models and samples.

use std::fs;
use std::path::{Path, PathBuf};

use opendr_engine::model::{Model, Sha256};
use opendr_engine::{Error, ErrorKind, Progress, Result, ResultExt};

use crate::assembly::{Assembly, absent_is_fine};
use crate::cache::Cache;
use crate::card::{Card, ItemKind};
use crate::embedded::embedded_cards;
use crate::fetch::Fetch;
use crate::http::Http;
use crate::item::Item;
use crate::models_package::ModelsPackage;
use crate::options::ZooOptions;
use crate::repository::{Repository, card_files, copy_container};
use crate::signature::RepositoryKey;
use crate::source_errors::SourceErrors;
use crate::stopped;

/// Maximum nesting of parts, by which an item that is its own part is detected.
const MAX_NESTING: usize = 4;

/// The models and samples of the cards, with the cache of downloaded ones.
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
    key: Option<RepositoryKey>,
    models: ModelsPackage,
    cache: Cache,
    http: Http,
}

impl Zoo {
    /// Creates the zoo of the built-in cards.
    ///
    /// # Errors
    /// `Format` for an invalid card, which the tests exclude.
    pub fn new(options: ZooOptions) -> Result<Self> {
        Ok(Self::with_cards(options, embedded_cards()?))
    }

    /// Creates a zoo of these cards only.
    pub fn with_cards(options: ZooOptions, cards: Vec<Card>) -> Self {
        Self {
            cards,
            offline: options.offline,
            repository: options.repository.as_deref().map(Repository::new),
            key: options.key,
            models: ModelsPackage::new(options.models),
            cache: Cache::new(options.cache),
            http: Http::new(options.timeout, options.retry_pause),
        }
    }

    /// Returns the cards.
    pub fn cards(&self) -> &[Card] {
        &self.cards
    }

    /// Returns every item of every card.
    pub fn items(&self) -> impl Iterator<Item = Item<'_>> {
        self.cards.iter().flat_map(|card| card.variants.iter().map(move |variant| Item { card, variant }))
    }

    /// Returns the item `learner/variant`, or the default variant of `learner`.
    ///
    /// # Errors
    /// `NotFound`, with the existing names.
    pub fn find(&self, spec: &str) -> Result<Item<'_>> {
        let (learner, variant) = spec.split_once('/').map_or((spec, None), |(name, rest)| (name, Some(rest)));
        let card = self.cards.iter().find(|card| card.learner == learner).ok_or_else(|| {
            let names: Vec<_> = self.cards.iter().map(|card| card.learner.as_str()).collect();
            Error::not_found(format!("the zoo has no {learner:?}; it has {}", names.join(", ")))
        })?;
        Ok(Item { card, variant: card.variant(variant)? })
    }

    /// Returns the path of the item's container or sample file if it is on this machine, in the repository's folder or the cache. Uses
    /// no network and verifies no checksum ([`Model::file`] does when it reads).
    pub fn cached(&self, spec: &str) -> Option<PathBuf> {
        self.ready(&self.find(spec).ok()?)
    }

    /// Returns the path of the item's container or sample file; downloads it if it is not cached.
    ///
    /// # Errors
    /// As [`Zoo::download`].
    pub fn get(&self, spec: &str, progress: &dyn Progress) -> Result<PathBuf> {
        let item = self.find(spec)?;
        self.check_signature(&item)?;
        match self.ready(&item) {
            Some(path) => Ok(path),
            None => self.fetch(&item, progress),
        }
    }

    /// Verifies every byte of the item and downloads it if it is missing or damaged. With `to`, also copies it into that folder as
    /// `<learner>/<variant>`, or under the name of the card, so that the folder is a model repository. Returns the folder of the
    /// container, or the file of a sample.
    ///
    /// # Errors
    /// `NotFound` for an unknown item, else an error that lists why each source failed: `Integrity` when a file differs from the
    /// card, `Network` when a source could not be reached.
    pub fn download(&self, spec: &str, to: Option<&Path>, progress: &dyn Progress) -> Result<PathBuf> {
        let item = self.find(spec)?;
        self.check_signature(&item)?;
        let path = match self.ready(&item) {
            None => self.fetch(&item, progress)?,
            Some(path) => match check_whole(&item, &path) {
                Ok(()) => path,
                // Containers in the user's own folder are never removed.
                Err(error) if self.own_container(&item).is_some() => return Err(error),
                Err(error) => {
                    progress.note(&format!("{error}: downloading it again"));
                    let folder = if path.is_file() { path.parent().unwrap_or(&path) } else { &path };
                    fs::remove_dir_all(folder).or_else(absent_is_fine)?;
                    self.fetch(&item, progress)?
                }
            },
        };
        match to {
            None => Ok(path),
            Some(folder) => copy_out(&item, &path, folder),
        }
    }

    /// Returns the path of the sample file `name`; downloads it if it is not cached.
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

    /// Returns the folder of the item made from the card's files.
    fn folder(&self, item: &Item<'_>) -> Result<PathBuf> {
        let recipe = Sha256::of(&self.recipe(item, MAX_NESTING)?);
        Ok(self.cache.item(&item.card.learner, &item.variant.name, &recipe))
    }

    /// Returns bytes that identify the contents of the item with its parts, which may come from the repository.
    fn recipe(&self, item: &Item<'_>, nesting: usize) -> Result<Vec<u8>> {
        let mut text = item.recipe()?;
        for (name, part) in &item.variant.parts {
            let part = self.find(part).context(|| format!("the part {name:?} of {item}"))?;
            let deeper = nesting.checked_sub(1).ok_or_else(|| {
                Error::format(format!(
                    "parts of {item} are nested more than {MAX_NESTING} deep; the item may be a part of itself"
                ))
            })?;
            text.extend(name.bytes().chain(self.recipe(&part, deeper)?));
            if let Some(path) = self.own_container(&part) {
                text.extend(Model::open(path)?.manifest().to_json()?);
            } else if let Some(address) = self.repository.as_ref().and_then(Repository::address) {
                text.extend(address.bytes());
            }
        }
        Ok(text)
    }

    /// Returns the parts of the item, downloaded and verified like any item.
    fn parts<'a>(&self, item: &Item<'a>, progress: &dyn Progress) -> Result<Vec<(&'a str, Model)>> {
        let part = |(name, part): (&'a String, &'a String)| {
            let model = self.download(part, None, progress).and_then(Model::open);
            Ok((name.as_str(), model.context(|| format!("the part {name:?} of {item}"))?))
        };
        item.variant.parts.iter().map(part).collect()
    }

    /// Returns the parts of the default model of `learner`, such as the detector of a face recogniser: each with its name and the item
    /// that it is, downloaded and verified. A container of a user's own network needs them too.
    ///
    /// # Errors
    /// The errors of [`Self::download`] for a part. A learner without models has no parts.
    pub fn default_parts(
        &self,
        learner: &str,
        progress: &dyn Progress,
    ) -> Result<Vec<(String, String, Model)>> {
        let Ok(item) = self.find(learner) else { return Ok(Vec::new()) };
        let models = self.parts(&item, progress)?;
        let named = item.variant.parts.values().zip(models);
        Ok(named.map(|(source, (name, model))| (name.to_owned(), source.clone(), model)).collect())
    }

    /// Returns the cache folder of a container from the repository's address, which is used only while that repository is set.
    fn folder_of_repository(&self, item: &Item<'_>) -> Option<PathBuf> {
        let address = self.repository.as_ref()?.address()?;
        let signer = self.key.as_ref().map_or_else(String::new, |key| format!(" by {}", key.base64()));
        let recipe = Sha256::of(format!("container at {address}{signer}").as_bytes());
        Some(self.cache.item(&item.card.learner, &item.variant.name, &recipe))
    }

    /// Returns the item's container in the repository's folder.
    fn own_container(&self, item: &Item<'_>) -> Option<PathBuf> {
        self.repository.as_ref()?.container(item)
    }

    /// Verifies the signature of the item's container in the repository's folder, if there are a container and a key.
    fn check_signature(&self, item: &Item<'_>) -> Result<()> {
        match (&self.key, self.own_container(item)) {
            (Some(key), Some(path)) => key.verify_folder(item, &path),
            _ => Ok(()),
        }
    }

    /// Returns the path of the item, if all its files have the right sizes.
    pub(crate) fn ready(&self, item: &Item<'_>) -> Option<PathBuf> {
        if let Some(path) = self.own_container(item) {
            return self.check_signature(item).is_ok().then_some(path);
        }
        let folder = self.folder(item).ok()?;
        if item.card.kind == ItemKind::Sample {
            let file = item.variant.files.first()?;
            return has(&folder, &file.name, file.size).then(|| folder.join(&file.name));
        }
        let is_whole = |folder: &PathBuf| {
            let files = Model::open(folder).and_then(|model| card_files(model.manifest()));
            files.is_ok_and(|files| files.iter().all(|file| has(folder, &file.name, file.size)))
        };
        self.folder_of_repository(item).into_iter().chain([folder]).find(is_whole)
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
            key: self.key.as_ref(),
            models: &self.models,
            offline: self.offline,
            progress,
        };
        let assembly = Assembly { item, cache: &self.cache, progress };
        let folder = self.folder(item)?;
        let mut tried = SourceErrors::default();
        match fetch.container(item) {
            Ok(None) => {}
            Ok(Some(manifest)) => {
                let folder = self.folder_of_repository(item).unwrap_or(folder);
                return assembly.of_container(&folder, manifest);
            }
            Err(error) if self.key.is_some() && error.kind() == ErrorKind::Integrity => return Err(error),
            Err(error) => tried.add("OPENDR_MODEL_REPOSITORY", error),
        }
        let parts = self.parts(item, progress)?;
        if let Some(path) = assembly.of_files(&folder, &parts)? {
            return Ok(path);
        }
        for source in &item.variant.sources {
            match fetch.files(item, source) {
                Ok(()) => match assembly.of_files(&folder, &parts)? {
                    Some(path) => return Ok(path),
                    None => tried.add(
                        source.to_string(),
                        Error::integrity("the files are damaged on disk after the download"),
                    ),
                },
                Err(_) if progress.stopped() => return Err(stopped()),
                Err(error) => tried.add(source.to_string(), error),
            }
        }
        Err(tried.error(item))
    }
}

fn has(folder: &Path, name: &str, size: u64) -> bool {
    fs::metadata(folder.join(name)).is_ok_and(|found| found.is_file() && found.len() == size)
}

/// Verifies every byte of the item.
fn check_whole(item: &Item<'_>, path: &Path) -> Result<()> {
    if item.card.kind == ItemKind::Sample {
        let bytes = fs::read(path)?;
        return item.variant.files.iter().try_for_each(|file| file.sha256.check(&file.name, &bytes));
    }
    let model = Model::open(path)?;
    model.manifest().files.iter().try_for_each(|file| model.file(&file.name).map(drop))
}

fn copy_out(item: &Item<'_>, path: &Path, folder: &Path) -> Result<PathBuf> {
    let target = folder.join(item.place());
    if item.card.kind == ItemKind::Model {
        return copy_container(&Model::open(path)?, &target);
    }
    let file = target.join(path.file_name().unwrap_or_default());
    fs::create_dir_all(&target)
        .and_then(|()| fs::copy(path, &file))
        .context(|| file.display().to_string())?;
    Ok(file)
}
