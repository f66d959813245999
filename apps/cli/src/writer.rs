//! Writer of annotated images and videos, on a thread of its own while inference continues.

use std::collections::HashSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::thread::{self, JoinHandle};

use opendr::learner::Outputs;
use opendr::vision::draw::{Style, draw};
use opendr::vision::{Frame, VideoWriter, save};
use opendr::{Error, Result, ResultExt};

/// Maximum number of frames that wait to be written, which bounds memory.
const WAITING: usize = 2;
/// Extensions of video outputs.
const VIDEOS: [&str; 3] = ["mp4", "mov", "mkv"];
/// Frame rate of a video made of images, in hertz.
const IMAGE_RATE: f64 = 25.0;

/// Errors of writing, with the input if there is one.
pub type Failures = Vec<(Option<PathBuf>, Error)>;

/// Writes annotated frames.
pub struct Writer {
    jobs: SyncSender<(Frame, Outputs)>,
    thread: JoinHandle<Failures>,
}

impl Writer {
    /// Creates a writer of `frames` frames (`None`: unknown) to `out`: a video if its extension is that of a video, an image if it
    /// has another extension, else a folder, which is created.
    ///
    /// # Errors
    /// `InvalidParam` for several frames into one image, `Io` when the folder cannot be created.
    pub fn new(out: &Path, frames: Option<u64>) -> Result<Self> {
        let place = Place::new(out);
        if matches!(place, Place::Image(_)) && frames != Some(1) {
            return Err(Error::invalid_param(format!(
                "{} is one image, but there may be several frames; give a folder, or a video (.mp4, .mov, .mkv)",
                out.display()
            )));
        }
        let folder = if matches!(place, Place::Folder { .. }) { Some(out) } else { out.parent() };
        if let Some(folder) = folder.filter(|folder| !folder.as_os_str().is_empty()) {
            fs::create_dir_all(folder).context(|| format!("creating the folder {}", folder.display()))?;
        }
        let (jobs, receiver) = sync_channel(WAITING);
        Ok(Self { jobs, thread: thread::spawn(move || write_all(place, &receiver)) })
    }

    /// Queues a frame to be drawn and written; blocks while the queue is full.
    ///
    /// # Errors
    /// `Internal` when the writing thread has ended.
    pub fn put(&self, frame: Frame, outputs: Outputs) -> Result<()> {
        self.jobs
            .send((frame, outputs))
            .map_err(|_| Error::internal("the thread that writes images has ended"))
    }

    /// Waits until all frames are written and returns the errors.
    pub fn finish(self) -> Failures {
        drop(self.jobs);
        let panicked = |_| vec![(None, Error::internal("the thread that writes images panicked"))];
        self.thread.join().unwrap_or_else(panicked)
    }
}

/// Destination of the frames.
enum Place {
    Image(PathBuf),
    Video(PathBuf, Video),
    Folder { path: PathBuf, taken: HashSet<PathBuf>, video: Option<(Arc<Path>, Video)> },
}

fn write_all(mut place: Place, jobs: &Receiver<(Frame, Outputs)>) -> Failures {
    let mut failures = Vec::new();
    for (mut frame, outputs) in jobs {
        outputs.iter().for_each(|(_, value)| draw(&mut frame.image, value, &Style::default()));
        let input = frame.path.to_path_buf();
        if let Err(error) = place.write(frame) {
            failures.push((Some(input), error));
        }
    }
    if let Err(error) = place.close() {
        failures.push((None, error));
    }
    failures
}

impl Place {
    fn new(out: &Path) -> Self {
        let extension = out.extension().filter(|_| !out.is_dir());
        let is_video = |extension: &str| VIDEOS.iter().any(|known| known.eq_ignore_ascii_case(extension));
        match extension.map(|extension| extension.to_str().is_some_and(is_video)) {
            Some(true) => Self::Video(out.to_owned(), Video::Unopened),
            Some(false) => Self::Image(out.to_owned()),
            None => Self::Folder { path: out.to_owned(), taken: HashSet::new(), video: None },
        }
    }

    fn write(&mut self, frame: Frame) -> Result<()> {
        match self {
            Self::Image(path) => save_beside(&frame, path),
            Self::Video(path, video) => video.write(&frame, path),
            Self::Folder { path: folder, taken, .. } if frame.video.is_none() => {
                save_beside(&frame, &free_name(folder, taken, &frame.path, image_extension(&frame.path)))
            }
            Self::Folder { path: folder, taken, video } => {
                let (path, video) = match video {
                    Some((path, video)) if video.is_of(&frame) => (path, video),
                    _ => {
                        if let Some((_, last)) = video.take() {
                            last.close()?;
                        }
                        let path = free_name(folder, taken, &frame.path, VIDEOS[0]);
                        let (path, video) = video.insert((path.into(), Video::Unopened));
                        (path, video)
                    }
                };
                video.write(&frame, path)
            }
        }
    }

    fn close(self) -> Result<()> {
        match self {
            Self::Video(_, video) | Self::Folder { video: Some((_, video)), .. } => video.close(),
            Self::Image(_) | Self::Folder { video: None, .. } => Ok(()),
        }
    }
}

/// A video being written.
enum Video {
    Unopened,
    Open(Arc<Path>, VideoWriter),
    /// Failed; the error is already recorded.
    Failed(Arc<Path>),
}

impl Video {
    /// Returns whether the video is made from the input of `frame`.
    fn is_of(&self, frame: &Frame) -> bool {
        matches!(self, Self::Open(input, _) | Self::Failed(input) if *input == frame.path)
    }

    fn write(&mut self, frame: &Frame, path: &Path) -> Result<()> {
        let written = self.try_write(frame, path);
        if written.is_err() {
            *self = Self::Failed(frame.path.clone());
        }
        written
    }

    fn try_write(&mut self, frame: &Frame, path: &Path) -> Result<()> {
        if let Self::Unopened = self {
            check_is_other(&frame.path, path)?;
            let rate = frame.video.as_ref().map_or(IMAGE_RATE, |video| video.frame_rate);
            *self = Self::Open(frame.path.clone(), VideoWriter::create(path, rate)?);
        }
        match self {
            Self::Open(_, writer) => writer.write(&frame.image),
            Self::Unopened | Self::Failed(_) => Ok(()),
        }
    }

    fn close(self) -> Result<()> {
        match self {
            Self::Open(_, writer) => writer.finish(),
            Self::Unopened | Self::Failed(_) => Ok(()),
        }
    }
}

fn save_beside(frame: &Frame, path: &Path) -> Result<()> {
    check_is_other(&frame.path, path)?;
    save(&frame.image, path)
}

/// Refuses to overwrite the input file.
fn check_is_other(input: &Path, output: &Path) -> Result<()> {
    let same =
        output.canonicalize().is_ok_and(|output| input.canonicalize().is_ok_and(|input| input == output));
    if !same {
        return Ok(());
    }
    Err(Error::invalid_param(format!("{} is the input itself; write to another folder", output.display())))
}

/// Returns the extension of a written image: the input's format if it can be written, else PNG.
fn image_extension(input: &Path) -> &'static str {
    let extension = input.extension().map(|extension| extension.to_string_lossy().to_ascii_lowercase());
    match extension.as_deref() {
        Some("jpg" | "jpeg") => "jpg",
        Some("bmp") => "bmp",
        Some("webp") => "webp",
        _ => "png",
    }
}

/// Returns a path in `folder` with the input's name, with a number added where two inputs share a name.
fn free_name(folder: &Path, taken: &mut HashSet<PathBuf>, input: &Path, extension: &str) -> PathBuf {
    let stem = input.file_stem().unwrap_or_else(|| "frame".as_ref());
    let mut number = 1;
    loop {
        let mut name = stem.to_owned();
        if number > 1 {
            name.push(format!("-{number}"));
        }
        name.push(".");
        name.push(extension);
        let path = folder.join(name);
        if taken.insert(path.clone()) {
            return path;
        }
        number += 1;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn extension_selects_the_destination() {
        assert!(matches!(Place::new(Path::new("seen")), Place::Folder { .. }));
        assert!(matches!(Place::new(Path::new("seen.MP4")), Place::Video(..)));
        assert!(matches!(Place::new(Path::new("seen.png")), Place::Image(_)));
        assert!(matches!(Place::new(&std::env::temp_dir()), Place::Folder { .. }));
    }

    #[test]
    fn inputs_of_one_name_get_numbers() {
        let mut taken = HashSet::new();
        let mut name = |input: &str| free_name(Path::new("out"), &mut taken, Path::new(input), "png");
        let names = ["a/1.png", "b/1.png", "b/2.x.tif"].map(&mut name);
        assert_eq!(names, ["out/1.png", "out/1-2.png", "out/2.x.png"].map(PathBuf::from));
    }
}
