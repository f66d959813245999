//! Weights trained by OpenDR itself: `models/weights` of the sources, and the data package `opendr-rs-models`.

use std::env;
use std::fs;
use std::path::{Path, PathBuf};

use opendr_engine::model::member_path;
use opendr_engine::{Error, Result, ResultExt};

use crate::card::CardFile;
use crate::loaded_from::loaded_from;
use crate::source::{MEMBERS, PACKAGE};

/// Folders in which the weights are searched.
#[derive(Debug)]
pub(crate) struct ModelsPackage {
    folders: Vec<PathBuf>,
}

impl ModelsPackage {
    pub(crate) fn new(folders: Vec<PathBuf>) -> Self {
        Self { folders }
    }

    /// Reads a file from the first folder that has it with the size and checksum of the card.
    pub(crate) fn read(&self, place: &str, file: &CardFile) -> Result<Vec<u8>> {
        let place = member_path(place)?;
        let mut differs = None;
        for path in self.folders.iter().map(|folder| folder.join(&place)) {
            let Ok(found) = fs::metadata(&path) else { continue };
            if found.len() != file.size {
                differs.get_or_insert_with(|| {
                    Error::integrity(format!(
                        "{} has {} bytes instead of {}",
                        path.display(),
                        found.len(),
                        file.size
                    ))
                });
                continue;
            }
            let bytes = fs::read(&path).context(|| path.display().to_string())?;
            match file.sha256.check(&path.display().to_string(), &bytes) {
                Ok(()) => return Ok(bytes),
                Err(error) => differs = Some(error),
            }
        }
        Err(differs.unwrap_or_else(|| {
            let folders: Vec<_> = self.folders.iter().map(|folder| folder.display().to_string()).collect();
            Error::not_found(match folders.is_empty() {
                true => "no folder on this machine has it".to_owned(),
                false => format!("not in {}", folders.join(", ")),
            })
        }))
    }

    /// Returns the error of a file that is neither on this machine nor could be downloaded.
    pub(crate) fn absent(&self, absent: &Error, got: &Error) -> Error {
        Error::new(
            got.kind(),
            format!(
                "{absent}; pip: {got}; run \"pip install {PACKAGE}\", or set OPENDR_MODELS to the folder of the weights \
                 (models/weights of OpenDR's sources)"
            ),
        )
    }
}

/// Returns the existing folders of this machine that may contain the weights: `OPENDR_MODELS`; the Python package beside OpenDR's;
/// `share/opendr/models` beside the program or library and under `XDG_DATA_HOME` and `XDG_DATA_DIRS`; a checkout of the sources
/// around the program.
pub(crate) fn installed() -> Vec<PathBuf> {
    let mut folders: Vec<PathBuf> = env::var_os("OPENDR_MODELS")
        .iter()
        .flat_map(env::split_paths)
        .filter(|path| !path.as_os_str().is_empty())
        .collect();
    let code: Vec<PathBuf> = loaded_from().into_iter().chain(env::current_exe().ok()).collect();
    for folder in code.iter().filter_map(|path| path.parent()) {
        // site-packages/opendr beside site-packages/opendr_rs_models; PREFIX/bin and PREFIX/lib beside PREFIX/share.
        folders.extend(folder.parent().map(|packages| packages.join(MEMBERS)));
        folders.extend(folder.parent().map(|prefix| prefix.join("share/opendr/models")));
    }
    folders.extend(data_folders().into_iter().map(|folder| folder.join("opendr/models")));
    let package = env::var_os("CARGO_MANIFEST_DIR").map(PathBuf::from);
    for path in package.iter().chain(&code) {
        folders.extend(path.ancestors().map(|folder| folder.join("models/weights")));
    }
    let mut known = Vec::new();
    folders.retain(|folder| {
        folder.is_dir() && !known.contains(folder) && {
            known.push(folder.clone());
            true
        }
    });
    folders
}

/// Returns the folders of the XDG base directory specification.
fn data_folders() -> Vec<PathBuf> {
    let home = env::var_os("XDG_DATA_HOME")
        .map(PathBuf::from)
        .or_else(|| env::var_os("HOME").map(|home| Path::new(&home).join(".local/share")));
    let shared = env::var_os("XDG_DATA_DIRS").unwrap_or_else(|| "/usr/local/share:/usr/share".into());
    home.into_iter()
        .chain(env::split_paths(&shared).collect::<Vec<_>>())
        .filter(|path| path.is_absolute())
        .collect()
}
