//! Items of the zoo.

use std::fmt;

use opendr_engine::Result;
use opendr_engine::model::{Lineage, Manifest};

use crate::card::{Card, Variant};
use crate::embedded::classes;
use crate::import::IMPORTER;
use crate::source::Source;

/// A downloadable item of the zoo: a variant of a card, named `learner/variant`.
#[derive(Debug, Clone, Copy)]
#[non_exhaustive]
pub struct Item<'a> {
    /// Card of the item.
    pub card: &'a Card,
    /// Variant of the card.
    pub variant: &'a Variant,
}

impl fmt::Display for Item<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.card.learner, self.variant.name)
    }
}

impl Item<'_> {
    /// Returns the relative path of the item in a folder of models.
    pub(crate) fn place(&self) -> String {
        self.variant.folder.clone().unwrap_or_else(|| self.to_string())
    }

    /// Returns the first source other than the user's repository.
    pub fn public_source(&self) -> Option<&Source> {
        self.variant.sources.iter().find(|source| !matches!(source, Source::Repository { .. }))
    }

    /// Returns the size in bytes of a download from the first public source: of the package that contains the files, or of the files.
    pub fn download_size(&self) -> u64 {
        let package = self.public_source().and_then(Source::package);
        package.map_or_else(|| self.variant.size(), |package| package.size)
    }

    /// Returns the manifest of the container, without files.
    pub(crate) fn manifest(&self) -> Manifest {
        let mut manifest = Manifest::new(&self.card.learner, &self.variant.name);
        manifest.task = self.card.task;
        manifest.params = self.variant.params.clone();
        manifest.classes = self.variant.classes.as_deref().and_then(classes).unwrap_or_default();
        manifest.inputs = self.variant.inputs.clone();
        manifest.licence = self.variant.licence.clone();
        manifest.metrics = self.variant.metrics.clone();
        manifest.lineage = Lineage {
            source: self.public_source().map(ToString::to_string).unwrap_or_default(),
            importer: if self.variant.import.is_empty() { String::new() } else { IMPORTER.to_owned() },
            command: format!("opendr download {self}"),
        };
        manifest
    }

    /// Returns bytes that identify the contents of the finished item except its parts, so that an item of an older card is not
    /// reused.
    pub(crate) fn recipe(&self) -> Result<Vec<u8>> {
        let mut text = self.manifest().to_json()?;
        text.extend(format!("{:?} {:?}", self.variant.files, self.variant.import).bytes());
        Ok(text)
    }
}
