//! Frames from files, folders, patterns, videos and cameras through one iterator.

mod folder;
mod frame;
mod glob;
mod input;
mod kind;
mod options;
mod pictures;
mod queue;
mod threaded;

#[cfg(test)]
mod tests;

use std::collections::VecDeque;
use std::path::Path;
use std::sync::Arc;

use opendr_engine::{Error, Result};

use crate::video::{Ffmpeg, VideoReader};

pub use frame::{Frame, VideoInfo};
pub use options::SourceOptions;
pub(crate) use threaded::FrameReader;

use input::{Segment, segments_of_inputs};
use pictures::Pictures;
use threaded::Threaded;

/// Frames from image files, folders, patterns, videos and cameras, read ahead in the background.
///
/// A file that cannot be read yields an `Err` that states its path, and reading resumes with the next file. Frames of
/// files are never dropped; from a camera, a slow consumer receives the newest frame and older ones are dropped.
/// Dropping the source ends its threads and child processes.
#[derive(Debug)]
pub struct Source {
    waiting: VecDeque<Segment>,
    reading: Option<Reading>,
    /// The video file that is read at present.
    video: Option<Arc<Path>>,
    options: SourceOptions,
    live: bool,
    length: Option<u64>,
    given: u64,
    dropped: u64,
}

#[derive(Debug)]
enum Reading {
    Pictures(Pictures),
    Threaded(Threaded),
    /// A video that could not be opened.
    Failed(Option<Error>),
}

impl Source {
    /// Opens `input`:
    ///
    /// * an image or video file, by its extension or else by its first bytes;
    /// * a folder: its images and videos, in natural order of their names;
    /// * a pattern such as `"photos/**/*.jpg"` (`*`, `?`, `[a-z]`, `**`);
    /// * a camera: `camera:0` or `/dev/video0`.
    ///
    /// # Errors
    /// `NotFound` when the input does not exist or contains nothing to read, `Io` when a folder cannot be read,
    /// `Unsupported` when a required program or system is missing, `Device` when a camera fails.
    pub fn open(input: impl AsRef<Path>) -> Result<Self> {
        Self::open_all([input], SourceOptions::default())
    }

    /// Opens several inputs, read one after the other.
    ///
    /// # Errors
    /// Those of [`Source::open`], for the first input that cannot be opened.
    pub fn open_all<P: AsRef<Path>>(
        inputs: impl IntoIterator<Item = P>,
        options: SourceOptions,
    ) -> Result<Self> {
        let segments = segments_of_inputs(inputs, &options)?;
        let mut source = Self {
            length: Some(0),
            live: false,
            waiting: segments.into(),
            reading: None,
            video: None,
            options,
            given: 0,
            dropped: 0,
        };
        for segment in &source.waiting {
            let length = match segment {
                Segment::Pictures(paths) => Some(paths.len() as u64),
                Segment::Video(_, Ok(info)) => info.frames,
                // One error takes the place of the video.
                Segment::Video(_, Err(_)) => Some(1),
                Segment::Camera(_) => None,
            };
            source.live |= matches!(segment, Segment::Camera(_));
            source.length = source.length.zip(length).map(|(sum, more)| sum + more);
        }
        source.start_next();
        Ok(source)
    }

    /// Creates a source from an iterator of frames, such as a camera with a driver of its own, which runs in a thread
    /// of its own. Of a `live` source, frames that the consumer is too slow for are dropped.
    ///
    /// The thread ends with the first frame after the source was dropped.
    pub fn from_frames(frames: impl Iterator<Item = Result<Frame>> + Send + 'static, live: bool) -> Self {
        let options = SourceOptions::default();
        let length = frames.size_hint().1.filter(|_| !live).map(|length| length as u64);
        let reading = Some(Reading::Threaded(Threaded::detached(frames, live, options.prefetch)));
        Self { waiting: VecDeque::new(), reading, video: None, options, live, length, given: 0, dropped: 0 }
    }

    /// Returns the number of frames, where the files state it; `None` when unknown or endless.
    pub fn len_hint(&self) -> Option<u64> {
        self.length
    }

    /// Returns whether the source is live, so that slow consumers lose frames.
    pub fn is_live(&self) -> bool {
        self.live
    }

    /// Returns whether only image files remain, no videos and no cameras.
    pub fn is_images(&self) -> bool {
        matches!(self.reading, None | Some(Reading::Pictures(_)))
            && self.waiting.iter().all(|segment| matches!(segment, Segment::Pictures(_)))
    }

    /// Returns the number of frames of live sources that were dropped.
    pub fn dropped(&self) -> u64 {
        let current = match &self.reading {
            Some(Reading::Threaded(threaded)) => threaded.dropped(),
            _ => 0,
        };
        self.dropped + current
    }

    /// Returns the file of the last item, also when that was an error. `None` before the first item, after the last,
    /// and for cameras and [`Source::from_frames`].
    pub fn current_path(&self) -> Option<&Path> {
        match &self.reading {
            Some(Reading::Pictures(pictures)) => pictures.last_path(),
            Some(Reading::Threaded(_) | Reading::Failed(_)) => self.video.as_deref(),
            None => None,
        }
    }

    fn start_next(&mut self) {
        self.dropped = self.dropped();
        self.reading = None;
        self.video = None;
        self.reading = self.waiting.pop_front().map(|segment| match segment {
            Segment::Pictures(paths) => Reading::Pictures(Pictures::new(paths, &self.options)),
            Segment::Video(path, info) => {
                let max_samples = self.options.decoder.max_samples;
                let path: Arc<Path> = path.into();
                self.video = Some(Arc::clone(&path));
                let reader =
                    info.and_then(|info| VideoReader::start(&Ffmpeg::default(), path, info, max_samples));
                match reader {
                    Ok(reader) => Reading::Threaded(Threaded::new(reader, false, self.options.prefetch)),
                    Err(error) => Reading::Failed(Some(error)),
                }
            }
            Segment::Camera(camera) => Reading::Threaded(Threaded::new(*camera, true, 1)),
        });
    }
}

impl Iterator for Source {
    type Item = Result<Frame>;

    fn next(&mut self) -> Option<Result<Frame>> {
        loop {
            let next = match self.reading.as_mut()? {
                Reading::Pictures(pictures) => pictures.next(),
                Reading::Threaded(threaded) => threaded.next(),
                Reading::Failed(error) => error.take().map(Err),
            };
            let Some(frame) = next else {
                self.start_next();
                continue;
            };
            let index = self.given;
            self.given += 1;
            return Some(frame.map(|frame| Frame { item_index: index, ..frame }));
        }
    }
}
