//! A picture and where it came from.

use std::path::Path;
use std::sync::Arc;

use opendr_engine::data::Image;

/// What is known of a video or camera.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VideoInfo {
    /// Frames a second, on average.
    pub rate: f64,
    /// How many frames there are, as far as the file tells.
    pub frames: Option<u64>,
    /// How long it is, seconds, as far as the file tells.
    pub duration_s: Option<f64>,
}

/// One picture of a [`crate::Source`].
#[derive(Debug, Clone)]
pub struct Frame {
    /// The picture. The stamp of its header is the time since the start of the video, or the time of taking for a
    /// camera; picture files have none.
    pub image: Image,
    /// The file or device it came from.
    pub path: Arc<Path>,
    /// Its number among what the source gave out, from 0; files that could not be read count too.
    pub index: u64,
    /// Its number in its video or camera, from 0, frames that were dropped included; 0 for a picture file.
    pub number: u64,
    /// Of the video or camera it came from; `None` for a picture file.
    pub video: Option<Arc<VideoInfo>>,
}

impl Frame {
    /// A name for what is made of the frame, without a folder and an extension: `bus` of `photos/bus.jpg`,
    /// `street_000012` for frame 12 of `street.mp4`. Bytes that are no UTF-8 are replaced.
    pub fn name(&self) -> String {
        let stem = self.path.file_stem().unwrap_or(self.path.as_os_str()).to_string_lossy();
        match self.video {
            Some(_) => format!("{stem}_{:06}", self.number),
            None => stem.into_owned(),
        }
    }
}
