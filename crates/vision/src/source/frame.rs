//! Frames and the videos that they come from.

use std::path::Path;
use std::sync::Arc;

use opendr_engine::data::Image;

/// Properties of a video or camera.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VideoInfo {
    /// Average frames per second.
    pub frame_rate: f64,
    /// Number of frames, where the file states it.
    pub frames: Option<u64>,
    /// Duration in seconds, where the file states it.
    pub duration_s: Option<f64>,
}

/// An image of a [`crate::Source`].
#[derive(Debug, Clone)]
pub struct Frame {
    /// The image. The stamp of its header is the time since the start of a video, or the capture time of a camera;
    /// image files have no stamp.
    pub image: Image,
    /// The file or device of the frame.
    pub path: Arc<Path>,
    /// Index among the items of the source, from 0; files that could not be read count too.
    pub item_index: u64,
    /// Index in its video or camera, from 0, dropped frames included; 0 for an image file.
    pub frame_index: u64,
    /// The video or camera of the frame; `None` for an image file.
    pub video: Option<Arc<VideoInfo>>,
}

impl Frame {
    /// Returns a name for files derived from the frame, without folder and extension: `bus` for `photos/bus.jpg`,
    /// `street_000012` for frame 12 of `street.mp4`. Invalid UTF-8 is replaced.
    pub fn name(&self) -> String {
        let stem = self.path.file_stem().unwrap_or(self.path.as_os_str()).to_string_lossy();
        match self.video {
            Some(_) => format!("{stem}_{:06}", self.frame_index),
            None => stem.into_owned(),
        }
    }
}
