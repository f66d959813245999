//! Model containers: a folder, or a zip, with `model.json` and the files that it lists.
//!
//! Containers may come from unknown sources. Nothing in one is executed or unpickled, no name leaves its folder, sizes
//! are checked before memory is allocated, and every file is checked against its sha256 on each read. The check takes 10
//! to 20 ms for 15 MB on a CPU with SHA instructions, so no earlier check is relied on.
//!
//! A model of several networks that are models of their own (a face recogniser and its face detector) contains them as
//! parts: whole containers in subfolders, whose files are among its files.

mod from_json;
mod manifest;
mod member;
mod part;
mod sha256;
mod store;
#[cfg(test)]
mod tests;
mod upstream;
mod writer;

use std::fs;
use std::io::Read;
use std::path::{Path, PathBuf};

pub use manifest::{FORMAT_VERSION, Licence, Lineage, Manifest, ModelFile};
pub use member::member_path;
pub use sha256::{Sha256, Sha256Hasher};
pub use writer::ModelWriter;

use crate::params::ParamMap;
use crate::target::Classes;
use crate::{Error, Result, ResultExt};
use store::Store;

/// Name of the manifest file of a container.
pub const MANIFEST_NAME: &str = "model.json";
/// Name of the network in a model of one network.
const NETWORK_NAME: &str = "model.onnx";

/// Maximum size of `model.json`, in bytes.
const MAX_MANIFEST_BYTES: u64 = 16 << 20;

/// An open container. Its manifest is in memory; its files are read on request.
#[derive(Debug, Clone)]
pub struct Model {
    path: PathBuf,
    manifest: Manifest,
    store: Store,
}

impl Model {
    /// Opens a container: its folder, its JSON file (OpenDR's own too), or a zip of it. An ONNX file alone is a model without
    /// a learner, classes and parameters.
    ///
    /// # Errors
    /// Returns `NotFound` if there is none at `path`; otherwise as [`Manifest::from_json`].
    pub fn open(path: impl AsRef<Path>) -> Result<Self> {
        let path = path.as_ref();
        let found = fs::metadata(path).context(|| format!("no model at {}", path.display()))?;
        let open = || -> Result<Self> {
            if found.is_dir() {
                let json = json_in_folder(path)?;
                return Self::from_store(path, Store::Folder(path.to_owned()), &json);
            }
            if starts_as_zip(path)? {
                let prefix = store::prefix_in_zip(path, MANIFEST_NAME)?;
                return Self::from_store(path, Store::Zip { path: path.to_owned(), prefix }, MANIFEST_NAME);
            }
            let folder =
                path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
            if is_onnx(path) {
                let manifest = Manifest::of_network(path)?;
                return Ok(Self { path: path.to_owned(), manifest, store: Store::Folder(folder.to_owned()) });
            }
            let manifest = Manifest::from_json(&store::read_file(path, MAX_MANIFEST_BYTES)?)?;
            Ok(Self { path: path.to_owned(), manifest, store: Store::Folder(folder.to_owned()) })
        };
        open().context(|| format!("opening the model {}", path.display()))
    }

    fn from_store(path: &Path, store: Store, json: &str) -> Result<Self> {
        let manifest = Manifest::from_json(&store.read_at_most(json, MAX_MANIFEST_BYTES)?)?;
        Ok(Self { path: path.to_owned(), manifest, store })
    }

    /// Returns the path of the container.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Returns the contents of `model.json`.
    pub fn manifest(&self) -> &Manifest {
        &self.manifest
    }

    /// Returns the names of the classes, in the order of the outputs.
    pub fn classes(&self) -> &Classes {
        &self.manifest.classes
    }

    /// Returns the parameters of the learner for these weights.
    pub fn params(&self) -> &ParamMap {
        &self.manifest.params
    }

    /// Checks that the model is one of `learner`. A model that names no learner (OpenDR's JSON) passes.
    ///
    /// # Errors
    /// Returns `InvalidInput` if it is a model of another learner.
    pub fn check_learner(&self, learner: &str) -> Result<()> {
        let owner = &self.manifest.learner;
        if owner.is_empty() || owner == learner {
            return Ok(());
        }
        Err(Error::invalid_input(format!(
            "the model {} belongs to the learner {owner:?}, not to {learner:?}; load it with {owner:?}",
            self.path.display()
        )))
    }

    /// Returns the bytes of the file `name`, checked against size and sha256. `model.onnx` also names the only ONNX file of a
    /// model that was not written by a learner, such as `bisenet.onnx`.
    ///
    /// # Errors
    /// Returns `NotFound` if the model lists no such file or it is missing, `Integrity` if it is damaged.
    pub fn file(&self, name: &str) -> Result<Vec<u8>> {
        let listed = self.manifest.files.iter().find(|file| file.name == name);
        let file = listed.or_else(|| self.only_onnx().filter(|_| name == NETWORK_NAME)).ok_or_else(|| {
            let names: Vec<_> = self.manifest.files.iter().map(|file| file.name.as_str()).collect();
            Error::not_found(format!(
                "the model {} has no file {name:?}; it has {}",
                self.path.display(),
                names.join(", ")
            ))
        })?;
        let read = || -> Result<Vec<u8>> {
            let bytes = match file.size {
                Some(size) => self.store.read_exactly(&file.name, size)?,
                None => self.store.read_at_most(&file.name, store::MAX_FILE_BYTES)?,
            };
            if let Some(sha256) = file.sha256 {
                sha256.check(&file.name, &bytes)?;
            }
            Ok(bytes)
        };
        read().context(|| format!("reading the model {}", self.path.display()))
    }

    /// Returns the bytes of the model's only ONNX file; files of parts do not count.
    ///
    /// # Errors
    /// Returns `NotFound` if it lists none, `InvalidInput` if it lists several; otherwise as [`Model::file`].
    pub fn onnx(&self) -> Result<Vec<u8>> {
        let mut files = self.onnx_files();
        match (self.only_onnx(), files.next(), files.next()) {
            (Some(file), ..) => self.file(&file.name),
            (None, Some(first), Some(second)) => Err(Error::invalid_input(format!(
                "the model {} has several ONNX files ({}, {}, ...); name one",
                self.path.display(),
                first.name,
                second.name
            ))),
            _ => Err(Error::not_found(format!("the model {} names no ONNX file", self.path.display()))),
        }
    }

    fn only_onnx(&self) -> Option<&ModelFile> {
        let mut files = self.onnx_files();
        files.next().filter(|_| files.next().is_none())
    }

    fn onnx_files(&self) -> impl Iterator<Item = &ModelFile> {
        self.own_files().filter(|file| is_onnx(Path::new(&file.name)))
    }
}

fn is_onnx(path: &Path) -> bool {
    path.extension().is_some_and(|end| end.eq_ignore_ascii_case("onnx"))
}

/// Returns the name of the JSON in a model's folder: `model.json`, or the only JSON file, as OpenDR writes it.
fn json_in_folder(folder: &Path) -> Result<String> {
    if folder.join(MANIFEST_NAME).is_file() {
        return Ok(MANIFEST_NAME.to_owned());
    }
    let entries =
        fs::read_dir(folder)?.take(10_000).filter_map(|entry| entry.ok()?.file_name().into_string().ok());
    let names: Vec<String> = entries.filter(|name| name.ends_with(".json")).collect();
    match names.as_slice() {
        [name] => Ok(name.clone()),
        [] => Err(Error::not_found(format!("no {MANIFEST_NAME} in the folder; it is not a model"))),
        _ => Err(Error::not_found(format!("no {MANIFEST_NAME} in the folder, but several others; name one"))),
    }
}

fn starts_as_zip(path: &Path) -> Result<bool> {
    // A pipe would block when opened; reading it as JSON returns an error.
    if !fs::metadata(path)?.is_file() {
        return Ok(false);
    }
    let mut start = Vec::with_capacity(4);
    fs::File::open(path)?.take(4).read_to_end(&mut start)?;
    Ok(start == b"PK\x03\x04")
}
