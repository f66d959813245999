//! Containers inside a container.

use super::store::Store;
use super::{MANIFEST_NAME, Manifest, Model, ModelFile, member_path};
use crate::{Error, Result, ResultExt};

impl Model {
    /// Returns the names of the models that this one contains as parts, e.g. `"detector"`: its folders with a `model.json`.
    pub fn parts(&self) -> impl Iterator<Item = &str> {
        parts_of(&self.manifest.files).filter(|name| !name.contains('/'))
    }

    /// Returns the model that this one contains as the part `name`; it may have parts too.
    ///
    /// # Errors
    /// Returns `NotFound` if there is none, `Integrity` if it is damaged or the name leaves the folder; otherwise as
    /// [`Manifest::from_json`].
    pub fn part(&self, name: &str) -> Result<Self> {
        let folder = member_path(name)?;
        if !parts_of(&self.manifest.files).any(|part| part == name) {
            let parts: Vec<_> = self.parts().collect();
            let parts = if parts.is_empty() { "none".to_owned() } else { parts.join(", ") };
            return Err(Error::not_found(format!(
                "the model {} contains no part {name:?}; it contains {parts}. Get the model with its parts from \
                 the zoo or from where it was saved",
                self.path.display()
            )));
        }
        let manifest = Manifest::from_json(&self.file(&format!("{name}/{MANIFEST_NAME}"))?)
            .context(|| format!("the part {name:?} of the model {}", self.path.display()))?;
        if let Some(file) = manifest.files.iter().find(|file| file.size.is_none() || file.sha256.is_none()) {
            return Err(Error::format(format!(
                "the file {:?} of the part {name:?} of the model {} has no size or no sha256",
                file.name,
                self.path.display()
            )));
        }
        let store = match &self.store {
            Store::Folder(root) => Store::Folder(root.join(&folder)),
            Store::Zip { path, prefix } => {
                Store::Zip { path: path.clone(), prefix: format!("{prefix}{name}/") }
            }
        };
        Ok(Self { path: self.path.join(folder), manifest, store })
    }

    /// Returns the files outside of all parts.
    pub(super) fn own_files(&self) -> impl Iterator<Item = &ModelFile> {
        self.manifest.files.iter().filter(|file| !self.parts().any(|part| inside(part, &file.name).is_some()))
    }
}

/// Returns the name of a file within the part, if it is in the part.
pub(super) fn inside<'a>(part: &str, name: &'a str) -> Option<&'a str> {
    name.strip_prefix(part)?.strip_prefix('/')
}

/// Returns the folders with a manifest, nested ones too.
pub(super) fn parts_of(files: &[ModelFile]) -> impl Iterator<Item = &str> {
    files.iter().filter_map(|file| file.name.strip_suffix(MANIFEST_NAME)?.strip_suffix('/'))
}
