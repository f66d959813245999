//! Stub for systems without camera support.

use std::path::Path;

use opendr_engine::{Error, Result};

use crate::source::{Frame, FrameReader, SourceOptions};

/// A type without values: no camera can be opened.
#[derive(Debug)]
pub(crate) enum Camera {}

impl Camera {
    /// # Errors
    /// Always `Unsupported`.
    pub(crate) fn open(path: &Path, _: &SourceOptions) -> Result<Self> {
        Err(Error::unsupported(format!(
            "the camera {} cannot be read on this system, only on 64-bit Linux; pass frames to \
             `Source::from_frames`, or read a video",
            path.display()
        )))
    }
}

impl Iterator for Camera {
    type Item = Result<Frame>;

    fn next(&mut self) -> Option<Result<Frame>> {
        match *self {}
    }
}

impl FrameReader for Camera {
    fn interrupt(&self) -> Box<dyn FnOnce() + Send> {
        match *self {}
    }
}
