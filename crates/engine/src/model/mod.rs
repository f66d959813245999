//! The model container: a folder, or one zip, with `model.json` and the files that it names.
//!
//! Containers come from anyone. Nothing in one is ever run or unpickled, no name leaves its folder, sizes are checked
//! before memory is taken, and every file is checked against its sha256 each time it is read: 15 MB take 10 to 20 ms
//! on a processor with SHA instructions, so no stamp of an earlier check is trusted.
//!
//! A model of several networks that are models of their own (a face recogniser with the detector that finds the faces)
//! carries them as parts: whole containers in folders of its own, whose files are among its files.

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

/// The file that makes a folder a model.
pub const MANIFEST_NAME: &str = "model.json";

/// `model.json` may have at most so many bytes.
const MAX_MANIFEST_BYTES: u64 = 16 << 20;

/// An opened container. Its manifest is read; its files are read when asked for.
#[derive(Debug, Clone)]
pub struct Model {
    path: PathBuf,
    manifest: Manifest,
    store: Store,
}

impl Model {
    /// Opens a container: its folder, its JSON file (OpenDR's own too), or a zip of it.
    ///
    /// # Errors
    /// `NotFound` when there is none at `path`, else as [`Manifest::from_json`].
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
            let manifest = Manifest::from_json(&store::read_file(path, MAX_MANIFEST_BYTES)?)?;
            Ok(Self { path: path.to_owned(), manifest, store: Store::Folder(folder.to_owned()) })
        };
        open().context(|| format!("opening the model {}", path.display()))
    }

    fn from_store(path: &Path, store: Store, json: &str) -> Result<Self> {
        let manifest = Manifest::from_json(&store.read_at_most(json, MAX_MANIFEST_BYTES)?)?;
        Ok(Self { path: path.to_owned(), manifest, store })
    }

    /// Where it was opened.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// All that `model.json` says.
    pub fn manifest(&self) -> &Manifest {
        &self.manifest
    }

    /// Names of the classes, in the order of the outputs.
    pub fn classes(&self) -> &Classes {
        &self.manifest.classes
    }

    /// The learner's parameters that belong to these weights.
    pub fn params(&self) -> &ParamMap {
        &self.manifest.params
    }

    /// Checks that the model was made for `learner`; one that names no learner (OpenDR's JSON) passes.
    ///
    /// # Errors
    /// `InvalidInput` when it was made for another.
    pub fn check_learner(&self, learner: &str) -> Result<()> {
        let made_for = &self.manifest.learner;
        if made_for.is_empty() || made_for == learner {
            return Ok(());
        }
        Err(Error::invalid_input(format!(
            "the model {} is made for the learner {made_for:?}, not for {learner:?}: load it with {made_for:?}",
            self.path.display()
        )))
    }

    /// The bytes of the file called `name`, checked against size and sha256.
    ///
    /// # Errors
    /// `NotFound` when the model names no such file or it is missing, `Integrity` when it is damaged.
    pub fn file(&self, name: &str) -> Result<Vec<u8>> {
        let file = self.manifest.files.iter().find(|file| file.name == name).ok_or_else(|| {
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

    /// The bytes of the model's one ONNX file; those of its parts do not count.
    ///
    /// # Errors
    /// `NotFound` when it names none, `InvalidInput` when it names several, else as [`Model::file`].
    pub fn onnx(&self) -> Result<Vec<u8>> {
        let is_onnx =
            |name: &str| Path::new(name).extension().is_some_and(|end| end.eq_ignore_ascii_case("onnx"));
        let mut names = self.own_files().map(|file| file.name.as_str()).filter(|name| is_onnx(name));
        match (names.next(), names.next()) {
            (Some(name), None) => self.file(name),
            (None, _) => {
                Err(Error::not_found(format!("the model {} names no ONNX file", self.path.display())))
            }
            (Some(first), Some(second)) => Err(Error::invalid_input(format!(
                "the model {} has several ONNX files ({first}, {second}, ...): ask for one by name",
                self.path.display()
            ))),
        }
    }
}

/// The name of the JSON in a model's folder: `model.json`, or the only one there, as OpenDR saves them.
fn json_in_folder(folder: &Path) -> Result<String> {
    if folder.join(MANIFEST_NAME).is_file() {
        return Ok(MANIFEST_NAME.to_owned());
    }
    let entries =
        fs::read_dir(folder)?.take(10_000).filter_map(|entry| entry.ok()?.file_name().into_string().ok());
    let names: Vec<String> = entries.filter(|name| name.ends_with(".json")).collect();
    match names.as_slice() {
        [name] => Ok(name.clone()),
        [] => Err(Error::not_found(format!("no {MANIFEST_NAME} in the folder: this is no model"))),
        _ => Err(Error::not_found(format!("no {MANIFEST_NAME} in the folder, but several others: name one"))),
    }
}

fn starts_as_zip(path: &Path) -> Result<bool> {
    // A pipe would block when opened; reading it as JSON refuses it.
    if !fs::metadata(path)?.is_file() {
        return Ok(false);
    }
    let mut start = Vec::with_capacity(4);
    fs::File::open(path)?.take(4).read_to_end(&mut start)?;
    Ok(start == b"PK\x03\x04")
}
