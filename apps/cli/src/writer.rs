//! Annotated pictures and videos, drawn and encoded on a thread of their own while the next frame is inferred.

use std::collections::HashSet;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::thread::{self, JoinHandle};

use opendr::learner::Outputs;
use opendr::vision::draw::{Style, draw};
use opendr::vision::{Frame, Source, VideoWriter, save};
use opendr::{Error, Result, ResultExt};

/// Frames that may wait to be written; more would only hold memory.
const WAITING: usize = 4;

/// Writes annotated frames.
pub struct Writer {
    jobs: SyncSender<(Frame, Outputs)>,
    thread: JoinHandle<Vec<(String, Error)>>,
}

impl Writer {
    /// A writer to `out`: a file for a source of one picture or of a video, when `out` has an extension; else a folder,
    /// which is made.
    ///
    /// # Errors
    /// `InvalidParam` when several pictures are to go into one file, `Io` when the folder cannot be made.
    pub fn new(out: &Path, source: &Source) -> Result<Self> {
        let is_file = out.extension().is_some() && !out.is_dir();
        if is_file && source.len_hint().is_some_and(|count| count > 1) {
            return Err(Error::invalid_param(format!(
                "{} is one file and the input holds several pictures; give a folder",
                out.display()
            )));
        }
        let folder = if is_file { out.parent().unwrap_or(Path::new("")) } else { out };
        if !folder.as_os_str().is_empty() {
            std::fs::create_dir_all(folder).context(|| format!("making the folder {}", folder.display()))?;
        }
        let (jobs, receiver) = sync_channel(WAITING);
        let mut place = Place { out: out.to_owned(), is_file, taken: HashSet::new(), video: None };
        Ok(Self { jobs, thread: thread::spawn(move || place.write_all(&receiver)) })
    }

    /// Hands a frame on to be drawn and written.
    ///
    /// # Errors
    /// `Internal` when the writing thread is gone.
    pub fn put(&self, frame: Frame, outputs: Outputs) -> Result<()> {
        self.jobs.send((frame, outputs)).map_err(|_| Error::internal("the writer is gone"))
    }

    /// Waits until all is written; what could not be, and why.
    pub fn finish(self) -> Vec<(String, Error)> {
        drop(self.jobs);
        self.thread.join().unwrap_or_else(|_| vec![(String::new(), Error::internal("the writer panicked"))])
    }
}

/// Where frames go.
struct Place {
    out: PathBuf,
    is_file: bool,
    taken: HashSet<PathBuf>,
    video: Option<Video>,
}

/// The video in hand; without a writer when it could not be begun, which is said once.
struct Video {
    input: Arc<Path>,
    writer: Option<VideoWriter>,
}

impl Place {
    fn write_all(&mut self, jobs: &Receiver<(Frame, Outputs)>) -> Vec<(String, Error)> {
        let mut failures = Vec::new();
        for (mut frame, outputs) in jobs {
            outputs.iter().for_each(|(_, value)| draw(&mut frame.image, value, &Style::default()));
            let input = frame.path.display().to_string();
            if let Err(error) = self.write(frame) {
                failures.push((input, error));
            }
        }
        if let Err(error) = self.close() {
            failures.push((self.out.display().to_string(), error));
        }
        failures
    }

    fn write(&mut self, frame: Frame) -> Result<()> {
        let Some(info) = frame.video else {
            let path = if self.is_file { self.out.clone() } else { self.free_name(&frame.path, None) };
            return save(&frame.image, &path);
        };
        if self.video.as_ref().is_none_or(|video| video.input != frame.path) {
            self.close()?;
            let path = if self.is_file { self.out.clone() } else { self.free_name(&frame.path, Some("mp4")) };
            self.video = Some(Video { input: frame.path, writer: None });
            let writer = VideoWriter::create(&path, info.rate)?;
            self.video.as_mut().map(|video| video.writer.insert(writer));
        }
        match self.video.as_mut().and_then(|video| video.writer.as_mut()) {
            Some(writer) => writer.write(&frame.image),
            None => Ok(()),
        }
    }

    fn close(&mut self) -> Result<()> {
        self.video.take().and_then(|video| video.writer).map_or(Ok(()), VideoWriter::finish)
    }

    /// The input's own name in the folder, with a number where two inputs have the same. Formats that are not written
    /// become PNG.
    fn free_name(&mut self, input: &Path, extension: Option<&'static str>) -> PathBuf {
        let stem = input.file_stem().map_or("frame".into(), |stem| stem.to_string_lossy()).replace(':', "-");
        let extension = extension.unwrap_or_else(|| match input.extension().and_then(|known| known.to_str()) {
            Some("jpg" | "jpeg" | "JPG" | "JPEG") => "jpg",
            Some("bmp") => "bmp",
            Some("webp") => "webp",
            _ => "png",
        });
        let mut path = self.out.join(format!("{stem}.{extension}"));
        let mut number = 1;
        while !self.taken.insert(path.clone()) {
            number += 1;
            path = self.out.join(format!("{stem}-{number}.{extension}"));
        }
        path
    }
}
