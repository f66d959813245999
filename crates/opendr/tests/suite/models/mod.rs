//! Real models and images for tests.

#![allow(clippy::unwrap_used, clippy::panic)]
#![allow(dead_code, reason = "each program uses some")]

use std::path::{Path, PathBuf};
use std::{env, fs};

use opendr::params::{ParamMap, ParamValue};
use opendr::zoo::{Zoo, ZooOptions};
use opendr::{Device, ErrorKind, Silent};

pub struct Models {
    shared: PathBuf,
    zoo: Zoo,
}

impl Models {
    /// Returns the models of `OPENDR_TEST_DATA`; others are downloaded from the public packages into a cache of the tests.
    pub fn find() -> Option<Self> {
        let Some(shared) = env::var_os("OPENDR_TEST_DATA").map(PathBuf::from) else {
            println!("skipped: no OPENDR_TEST_DATA");
            return None;
        };
        let root = PathBuf::from(env::var_os("CARGO_MANIFEST_DIR")?).join("../..");
        let cache =
            env::var_os("OPENDR_TEST_CACHE").map_or_else(|| root.join("target/test-cache"), PathBuf::from);
        let mut options = ZooOptions::new(cache.join("opendr"));
        options.repository = Some(shared.join("models").to_string_lossy().into_owned());
        Some(Self { zoo: Zoo::new(options).unwrap(), shared })
    }

    pub fn data(&self, name: &str) -> PathBuf {
        self.shared.join("data").join(name)
    }

    /// Returns the container of a learner; prints a line and returns `None` without a network or for a learner without weights.
    pub fn get(&self, spec: &str) -> Option<PathBuf> {
        if self.zoo.cards().iter().any(|card| card.learner == spec && card.variants.is_empty()) {
            println!("skipped: no weights for {spec}; the tests beside it train some");
            return None;
        }
        match self.zoo.get(spec, &Silent) {
            Ok(path) if spec == "visual_odometry" => Some(calibrated(spec, &path)),
            Ok(path) => Some(path),
            Err(error) if error.kind() == ErrorKind::Network => {
                println!("skipped: no network for {spec}: {error}");
                None
            }
            Err(error) => panic!("{spec}: {error}"),
        }
    }
}

/// Returns a container with the calibration of a camera, without which visual odometry refuses images.
fn calibrated(name: &str, path: &Path) -> PathBuf {
    let calibration = [("focal_length", 160.0), ("baseline", 0.4)];
    let params = calibration.map(|(name, value)| (name.to_owned(), ParamValue::Float(value)));
    let mut learner =
        opendr::registry().find(name).unwrap().make(&ParamMap::from(params), Device::Cpu).unwrap();
    learner.load(path).unwrap();
    let folder = env::temp_dir().join(format!("opendr-calibrated-{}-{name}", std::process::id()));
    fs::remove_dir_all(&folder).ok();
    learner.save(&folder).unwrap();
    folder
}
