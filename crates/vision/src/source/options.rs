//! How a source reads.

use std::thread;

use crate::codec::Decoder;

/// How a [`crate::Source`] reads; the defaults suit most.
#[derive(Debug, Clone, PartialEq)]
pub struct SourceOptions {
    /// Reads picture files; its limit on samples also bounds the frames of videos and cameras.
    pub decoder: Decoder,
    /// Threads that decode picture files.
    pub threads: usize,
    /// Frames of files that may wait; of live sources only the newest one does.
    pub ahead: usize,
    /// `[width, height]` wished from a camera, pixels; `None` takes what it is set to.
    pub camera_size: Option<[u32; 2]>,
}

impl Default for SourceOptions {
    /// A decoding thread for each core, 4 at most, and up to 4 frames ahead.
    fn default() -> Self {
        let threads = thread::available_parallelism().map_or(1, usize::from).min(4);
        Self { decoder: Decoder::default(), threads, ahead: 4, camera_size: None }
    }
}
