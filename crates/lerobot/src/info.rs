//! The file `meta/info.json`.

use std::collections::BTreeMap;

use opendr_engine::{Error, Result};
use serde::{Deserialize, Serialize, Serializer};
use serde_json::{Map, Value};

/// Description of a data set.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Info {
    /// Version of the format: `v3.0`.
    pub codebase_version: String,
    /// Type of the robot; none if unknown.
    #[serde(default)]
    pub robot_type: Option<String>,
    /// Number of episodes.
    pub total_episodes: usize,
    /// Number of frames.
    pub total_frames: usize,
    /// Number of tasks.
    #[serde(default)]
    pub total_tasks: usize,
    /// Files per folder.
    #[serde(default = "chunks_size")]
    pub chunks_size: usize,
    /// Frames per second.
    #[serde(serialize_with = "whole_number")]
    pub fps: f64,
    /// Ranges of episodes by name.
    #[serde(default)]
    pub splits: BTreeMap<String, String>,
    /// Pattern of the tables' paths.
    pub data_path: String,
    /// Pattern of the videos' paths; none without videos.
    #[serde(default)]
    pub video_path: Option<String>,
    /// Features by name.
    pub features: BTreeMap<String, Feature>,
    /// Other entries.
    #[serde(flatten)]
    pub other: Map<String, Value>,
}

/// A feature of the frames.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Feature {
    /// Type of its numbers, or `video`, `image` or `string`.
    pub dtype: String,
    /// Lengths of the axes.
    pub shape: Vec<usize>,
    /// Names of its numbers, in any of the layouts of LeRobot.
    #[serde(default)]
    pub names: Value,
    /// Other entries, such as those of a video.
    #[serde(flatten)]
    pub other: Map<String, Value>,
}

/// Writes a number without fraction as an integer, which LeRobot expects of frequencies.
fn whole_number<S: Serializer>(number: &f64, serializer: S) -> std::result::Result<S::Ok, S::Error> {
    match number.fract() == 0.0 && number.abs() < 1e9 {
        true => serializer.serialize_i64(*number as i64),
        false => serializer.serialize_f64(*number),
    }
}

fn chunks_size() -> usize {
    1000
}

/// Numbers per frame of a feature at most.
const MOST_NUMBERS: usize = 1 << 24;

impl Feature {
    /// Creates a feature of numbers, with a name for each, or none.
    pub fn new(dtype: &str, shape: Vec<usize>, names: &[String]) -> Self {
        let names = if names.is_empty() { Value::Null } else { names.into() };
        Self { dtype: dtype.to_owned(), shape, names, other: Map::new() }
    }

    /// Returns the number of numbers per frame.
    ///
    /// # Errors
    /// `Format` where it is zero or too large.
    pub fn width(&self) -> Result<usize> {
        let product = self.shape.iter().try_fold(1usize, |product, &length| product.checked_mul(length));
        product.filter(|width| (1..=MOST_NUMBERS).contains(width)).ok_or_else(|| {
            Error::format(format!("a feature of shape {:?}; each length must be at least 1", self.shape))
        })
    }

    /// Returns whether each frame has numbers, as opposed to an image or text.
    pub fn is_numeric(&self) -> bool {
        !matches!(self.dtype.as_str(), "video" | "image" | "string")
    }

    /// Returns whether it is a video.
    pub fn is_video(&self) -> bool {
        self.dtype == "video"
    }
}

impl Info {
    /// Returns the names of the features that are videos.
    pub fn video_keys(&self) -> impl Iterator<Item = &str> {
        self.features.iter().filter(|(_, feature)| feature.is_video()).map(|(name, _)| name.as_str())
    }

    /// Returns whether the format is v3.0; otherwise it is v2.0 or v2.1.
    ///
    /// # Errors
    /// `Unsupported` for another version.
    pub fn is_version_3(&self) -> Result<bool> {
        match self.codebase_version.as_str() {
            "v3.0" => Ok(true),
            "v2.0" | "v2.1" => Ok(false),
            other => Err(Error::unsupported(format!(
                "the data set has version {other:.20?}; OpenDR reads v2.0, v2.1 and v3.0, convert it with LeRobot"
            ))),
        }
    }
}
