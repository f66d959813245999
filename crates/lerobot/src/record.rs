//! What a data set states about an episode.

use std::collections::BTreeMap;
use std::path::PathBuf;

use crate::FeatureStatistics;

/// An episode of a data set.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct EpisodeRecord {
    /// Index of the episode.
    pub index: usize,
    /// Number of frames.
    pub length: usize,
    /// Tasks, in words.
    pub tasks: Vec<String>,
    /// Table with its frames.
    pub data: PathBuf,
    /// Videos by the name of their feature.
    pub videos: BTreeMap<String, VideoSegment>,
    /// Statistics of the features; empty where the data set has none.
    pub statistics: BTreeMap<String, FeatureStatistics>,
}

/// The part of a video file that shows an episode.
#[derive(Debug, Clone, PartialEq)]
pub struct VideoSegment {
    /// Video file.
    pub path: PathBuf,
    /// Time of the first frame, in seconds.
    pub from: f64,
    /// Time after the last frame, in seconds.
    pub to: f64,
}
