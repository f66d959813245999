//! Writing of video files.

use std::ffi::OsString;
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdin, Stdio};

use opendr_engine::data::{Image, Layout, PixelFormat, Pixels};
use opendr_engine::{Error, Result, ResultExt};

use crate::video::ffmpeg::{Complaints, Ffmpeg};

const CONTAINERS: [&str; 3] = ["mp4", "mov", "mkv"];

/// Writes images to a video file (H.264 where the installed `ffmpeg` has an encoder for it).
///
/// The file appears complete when [`VideoWriter::finish`] is called, or not at all.
#[derive(Debug)]
pub struct VideoWriter {
    programs: Ffmpeg,
    path: PathBuf,
    partial: PathBuf,
    rate: f64,
    encoder: Option<Encoder>,
    /// Set after a failure: the cause is reported once, and later writes fail.
    failed: bool,
}

#[derive(Debug)]
struct Encoder {
    child: Child,
    pixels: Option<ChildStdin>,
    complaints: Complaints,
    width: usize,
    height: usize,
}

impl VideoWriter {
    /// Creates a writer to `path` (`.mp4`, `.mov` or `.mkv`) with `rate` frames per second. The first image fixes the
    /// size.
    ///
    /// # Errors
    /// `Unsupported` for another extension, `InvalidParam` for a rate outside 0.01..=1000, `NotFound` when the folder
    /// does not exist.
    pub fn create(path: impl AsRef<Path>, rate: f64) -> Result<Self> {
        Self::with_programs(path.as_ref(), rate, Ffmpeg::default())
    }

    fn with_programs(path: &Path, rate: f64, programs: Ffmpeg) -> Result<Self> {
        let extension = path.extension().and_then(|extension| extension.to_str()).unwrap_or_default();
        if !CONTAINERS.iter().any(|known| known.eq_ignore_ascii_case(extension)) {
            return Err(Error::unsupported(format!(
                "unsupported video format of {}; end the file name with .mp4, .mov or .mkv",
                path.display()
            )));
        }
        if !(0.01..=1000.0).contains(&rate) {
            return Err(Error::invalid_param(format!(
                "the rate is {rate} frames per second; set it to a value from 0.01 to 1000"
            )));
        }
        let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
        if let Some(folder) = folder.filter(|folder| !folder.is_dir()) {
            return Err(Error::not_found(format!(
                "the folder {} does not exist; create it first",
                folder.display()
            )));
        }
        let mut name = path.file_stem().unwrap_or_default().to_owned();
        name.push(format!(".{}.partial.{extension}", std::process::id()));
        let partial = path.with_file_name(name);
        Ok(Self { programs, path: path.to_owned(), partial, rate, encoder: None, failed: false })
    }

    /// Adds an image. Waits while the encoder is busy.
    ///
    /// # Errors
    /// `InvalidInput` when the size differs from the first image's, `Unsupported` when `ffmpeg` is not installed,
    /// `Io` when it fails.
    pub fn write(&mut self, image: &Image) -> Result<()> {
        let written = self.write_frame(image);
        written.context(|| format!("writing {}", self.path.display()))
    }

    /// Completes the file.
    ///
    /// # Errors
    /// `InvalidInput` when no image was written, `Io` when `ffmpeg` fails.
    pub fn finish(mut self) -> Result<()> {
        let finished = match self.encoder.take() {
            None if self.failed => Err(Error::io("an earlier frame could not be written")),
            None => Err(Error::invalid_input("no frame was written; a video needs at least one")),
            Some(encoder) => encoder.finish().and_then(|()| Ok(fs::rename(&self.partial, &self.path)?)),
        };
        finished.context(|| format!("writing {}", self.path.display()))
    }

    fn write_frame(&mut self, image: &Image) -> Result<()> {
        if self.failed {
            return Err(Error::io("an earlier frame could not be written"));
        }
        let (width, height) = (image.width(), image.height());
        let encoder = match &mut self.encoder {
            Some(encoder) => encoder,
            None => {
                let encoder = Encoder::start(&self.programs, &self.partial, self.rate, width, height)?;
                self.encoder.insert(encoder)
            }
        };
        if (encoder.width, encoder.height) != (width, height) {
            return Err(Error::invalid_input(format!(
                "the image has {width}x{height} pixels and the video {}x{}; resize the image, or write another file",
                encoder.width, encoder.height
            )));
        }
        let ready = image.format() == PixelFormat::Rgb && image.layout() == Layout::Hwc;
        let written = match (image.pixels(), &mut encoder.pixels) {
            (Pixels::U8(samples), Some(pipe)) if ready => pipe.write_all(samples),
            (_, Some(pipe)) => pipe.write_all(&image.hwc_u8(PixelFormat::Rgb)),
            (_, None) => Ok(()),
        };
        let Err(error) = written else { return Ok(()) };
        self.failed = true;
        match self.encoder.take().map(Encoder::finish) {
            Some(Err(reason)) => Err(reason),
            _ => Err(error.into()),
        }
    }
}

impl Drop for VideoWriter {
    fn drop(&mut self) {
        if let Some(encoder) = &mut self.encoder {
            // Both fail only when the process has already ended.
            let _ = encoder.child.kill();
            let _ = encoder.child.wait();
        }
        // After a rename there is no such file.
        let _ = fs::remove_file(&self.partial);
    }
}

impl Encoder {
    fn start(programs: &Ffmpeg, file: &Path, rate: f64, width: usize, height: usize) -> Result<Self> {
        let mut output = OsString::from("file:");
        output.push(file);
        let (size, rate) = (format!("{width}x{height}"), rate.to_string());
        let mut arguments: Vec<OsString> = ["-y", "-nostats", "-hide_banner", "-loglevel", "level+error"]
            .into_iter()
            .chain(["-f", "rawvideo", "-pix_fmt", "rgb24", "-s", &size, "-r", &rate, "-i", "pipe:0"])
            // Chroma at half resolution, which every player supports, needs even sides.
            .chain(["-vf", "pad=ceil(iw/2)*2:ceil(ih/2)*2", "-pix_fmt", "yuv420p"])
            .chain(["-preset", "veryfast", "-crf", "20"])
            .map(OsString::from)
            .collect();
        arguments.push(output);
        let mut child = Ffmpeg::spawn(&programs.ffmpeg, &arguments, Stdio::piped())?;
        let pixels = child.stdin.take();
        let errors = child.stderr.take().ok_or_else(|| Error::internal("a child without pipes"))?;
        let complaints = Complaints::read(errors, |_| {});
        Ok(Self { child, pixels, complaints, width, height })
    }

    fn finish(mut self) -> Result<()> {
        drop(self.pixels.take());
        let complaint = self.complaints.finish();
        let status = self.child.wait()?;
        if status.success() {
            return Ok(());
        }
        let reason = complaint.unwrap_or_else(|| format!("it exited with {status}"));
        Err(Error::io(format!("ffmpeg could not encode the video: \"{reason}\"")))
    }
}
