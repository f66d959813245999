//! Options of the zoo.

use std::env;
use std::path::PathBuf;
use std::time::Duration;

use opendr_engine::{Result, cache_dir};

use crate::models_package::installed;
use crate::signature::RepositoryKey;

/// Options of a [`Zoo`](crate::Zoo).
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct ZooOptions {
    /// Cache folder, which other processes may share.
    pub cache: PathBuf,
    /// Folder or http(s) address that is used before all other sources.
    pub repository: Option<String>,
    /// Key by which the containers of `repository` must be signed; without one they need no signature.
    pub key: Option<RepositoryKey>,
    /// Folders in which OpenDR's own weights are searched, in this order; each like `models/weights` of the sources.
    pub models: Vec<PathBuf>,
    /// Whether to avoid the network.
    pub offline: bool,
    /// Maximum wait for data from a server.
    pub timeout: Duration,
    /// Pause before the first retry of a failed request; it doubles each time.
    pub retry_pause: Duration,
}

impl ZooOptions {
    /// Creates default options with this cache folder and no repository; OpenDR's own weights are read from `OPENDR_MODELS` and the
    /// installed package `opendr-rs-models`.
    pub fn new(cache: impl Into<PathBuf>) -> Self {
        Self {
            cache: cache.into(),
            repository: None,
            key: None,
            models: installed(),
            offline: false,
            timeout: Duration::from_secs(20),
            retry_pause: Duration::from_millis(500),
        }
    }

    /// Creates options from the environment: the cache is [`cache_dir`], the repository `OPENDR_MODEL_REPOSITORY`, its key
    /// `OPENDR_MODEL_KEY`, and `OPENDR_OFFLINE` other than `0` disables the network.
    ///
    /// # Errors
    /// `NotFound` without a folder for the cache, `InvalidParam` for a key that cannot be read.
    pub fn from_env() -> Result<Self> {
        let mut options = Self::new(cache_dir()?);
        let given = |name: &str| env::var(name).ok().filter(|text| !text.is_empty());
        options.repository = given("OPENDR_MODEL_REPOSITORY");
        options.key = given("OPENDR_MODEL_KEY").as_deref().map(RepositoryKey::new).transpose()?;
        options.offline =
            env::var_os("OPENDR_OFFLINE").is_some_and(|value| !value.is_empty() && value != "0");
        Ok(options)
    }
}
