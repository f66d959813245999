//! Options of a source.

use std::thread;

use crate::codec::Decoder;

/// Options of a [`crate::Source`].
#[derive(Debug, Clone, PartialEq)]
pub struct SourceOptions {
    /// Decoder of image files; its limit on samples also applies to the frames of videos and cameras.
    pub decoder: Decoder,
    /// Number of threads that decode image files.
    pub threads: usize,
    /// Number of frames of files that are read ahead; live sources keep only the newest frame.
    pub prefetch: usize,
    /// Requested camera resolution `[width, height]` in pixels; `None` keeps the camera's setting.
    pub camera_size: Option<[u32; 2]>,
}

impl Default for SourceOptions {
    /// Sets one decoding thread per core, at most 4, and as many as 4 frames ahead.
    fn default() -> Self {
        let threads = thread::available_parallelism().map_or(1, usize::from).min(4);
        Self { decoder: Decoder::default(), threads, prefetch: 4, camera_size: None }
    }
}
