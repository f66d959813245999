//! Where the zoo keeps and finds things.

use std::env;
use std::path::PathBuf;
use std::time::Duration;

use opendr_engine::{Result, cache_dir};

use crate::models_package::installed;

/// How a [`Zoo`](crate::Zoo) works.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct ZooOptions {
    /// The cache folder, which other processes may share.
    pub cache: PathBuf,
    /// A folder or an http(s) address that is asked before all other sources.
    pub repository: Option<String>,
    /// Folders in which weights of our own are looked for, in this order; each as `models/weights` of the sources.
    pub models: Vec<PathBuf>,
    /// Never use the network.
    pub offline: bool,
    /// Longest wait for a server to go on.
    pub timeout: Duration,
    /// First pause before a failed request is repeated; it doubles each time.
    pub retry_pause: Duration,
}

impl ZooOptions {
    /// The defaults with this cache folder and no repository; weights of our own are read from `OPENDR_MODELS` and where the package
    /// `opendr-rs-models` is installed.
    pub fn new(cache: impl Into<PathBuf>) -> Self {
        Self {
            cache: cache.into(),
            repository: None,
            models: installed(),
            offline: false,
            timeout: Duration::from_secs(20),
            retry_pause: Duration::from_millis(500),
        }
    }

    /// As the environment says: the cache is [`cache_dir`], the repository `OPENDR_MODEL_REPOSITORY`, and
    /// `OPENDR_OFFLINE` set to anything but `0` keeps off the network.
    ///
    /// # Errors
    /// `NotFound` when there is no folder for the cache.
    pub fn from_env() -> Result<Self> {
        let mut options = Self::new(cache_dir()?);
        options.repository = env::var("OPENDR_MODEL_REPOSITORY").ok().filter(|text| !text.is_empty());
        options.offline =
            env::var_os("OPENDR_OFFLINE").is_some_and(|value| !value.is_empty() && value != "0");
        Ok(options)
    }
}
