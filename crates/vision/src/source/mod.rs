//! Pictures from anywhere behind one iterator: files, folders, patterns, videos, cameras.

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

/// Frames from picture files, folders, patterns, videos and cameras, read ahead in the background.
///
/// A file that cannot be read is an `Err` that names it, and reading goes on with the next. Of files no frame is ever
/// left out, however slow the consumer; of a camera it gets the newest frame, and what it had no time for is
/// dropped. Dropping the source ends its threads and child processes.
#[derive(Debug)]
pub struct Source {
    waiting: VecDeque<Segment>,
    reading: Option<Reading>,
    /// The video file that is being read.
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
    /// Opens what `input` names:
    ///
    /// * a picture or video file, by its name's extension, else by its first bytes;
    /// * a folder: the pictures and videos in it, in the order of their names (numbers by value);
    /// * a pattern such as `"photos/**/*.jpg"` (`*`, `?`, `[a-z]`, `**`);
    /// * a camera: `camera:0` or `/dev/video0`.
    ///
    /// # Errors
    /// `NotFound` when the input does not exist or holds nothing to read, `Io` when a folder cannot be read,
    /// `Unsupported` when it takes a program or system that is not there, `Device` when a camera does not do.
    pub fn open(input: impl AsRef<Path>) -> Result<Self> {
        Self::open_all([input], SourceOptions::default())
    }

    /// Opens several inputs, read one after the other.
    ///
    /// # Errors
    /// See [`Source::open`]; the first input that cannot be opened decides.
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
                // One error in its place.
                Segment::Video(_, Err(_)) => Some(1),
                Segment::Camera(_) => None,
            };
            source.live |= matches!(segment, Segment::Camera(_));
            source.length = source.length.zip(length).map(|(sum, more)| sum + more);
        }
        source.start_next();
        Ok(source)
    }

    /// Makes a source of any other frames, such as a camera with a driver of its own, read in a thread of their own.
    /// Frames of a `live` source that the consumer has no time for are dropped.
    ///
    /// The thread ends with the first frame that arrives after the source was dropped.
    pub fn from_frames(frames: impl Iterator<Item = Result<Frame>> + Send + 'static, live: bool) -> Self {
        let options = SourceOptions::default();
        let length = frames.size_hint().1.filter(|_| !live).map(|length| length as u64);
        let reading = Some(Reading::Threaded(Threaded::detached(frames, live, options.ahead)));
        Self { waiting: VecDeque::new(), reading, video: None, options, live, length, given: 0, dropped: 0 }
    }

    /// How many frames there will be, as far as files tell; `None` when unknown or endless.
    pub fn len_hint(&self) -> Option<u64> {
        self.length
    }

    /// Whether frames are taken while they are read, so that slow consumers miss some.
    pub fn is_live(&self) -> bool {
        self.live
    }

    /// Whether what is left are picture files only, no videos and no cameras.
    pub fn is_pictures(&self) -> bool {
        matches!(self.reading, None | Some(Reading::Pictures(_)))
            && self.waiting.iter().all(|segment| matches!(segment, Segment::Pictures(_)))
    }

    /// How many frames a slow consumer of a live source has missed.
    pub fn dropped(&self) -> u64 {
        let current = match &self.reading {
            Some(Reading::Threaded(threaded)) => threaded.dropped(),
            _ => 0,
        };
        self.dropped + current
    }

    /// The file that the item just given out came from, also when that was an error. `None` when there was none yet or
    /// is none left, and for cameras and frames that a program makes.
    pub fn last_path(&self) -> Option<&Path> {
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
                    Ok(reader) => Reading::Threaded(Threaded::new(reader, false, self.options.ahead)),
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
            return Some(frame.map(|frame| Frame { index, ..frame }));
        }
    }
}
