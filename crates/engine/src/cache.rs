//! The folder of downloaded files.

use std::env;
use std::path::PathBuf;

use crate::{Error, Result};

/// Returns the cache folder: `OPENDR_CACHE`, or `opendr` in the user's cache folder. It may not exist yet.
///
/// # Errors
/// Returns `NotFound` if neither is known.
pub fn cache_dir() -> Result<PathBuf> {
    if let Some(folder) = variable("OPENDR_CACHE") {
        return Ok(folder);
    }
    user_cache_dir().map(|folder| folder.join("opendr")).ok_or_else(|| {
        Error::not_found(
            "no folder for the cache: neither OPENDR_CACHE nor the home folder is set; set OPENDR_CACHE",
        )
    })
}

fn variable(name: &str) -> Option<PathBuf> {
    env::var_os(name).filter(|value| !value.is_empty()).map(PathBuf::from)
}

fn user_cache_dir() -> Option<PathBuf> {
    if cfg!(windows) {
        variable("LOCALAPPDATA")
    } else if cfg!(target_os = "macos") {
        env::home_dir().map(|home| home.join("Library/Caches"))
    } else {
        variable("XDG_CACHE_HOME").or_else(|| env::home_dir().map(|home| home.join(".cache")))
    }
}
