//! The frames of a video file.

use std::io::Read;
use std::path::Path;
use std::process::{Child, ChildStdout, Stdio};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, Receiver};
use std::sync::{Arc, Mutex, PoisonError};

use opendr_engine::data::Image;
use opendr_engine::{Error, Result, ResultExt};

use crate::codec::LIMIT_VARIABLE;
use crate::source::{Frame, FrameReader, VideoInfo};
use crate::video::ffmpeg::{Complaints, Ffmpeg, input_arguments};
use crate::video::frame_line::FrameLine;

/// A decoder of a video in a child process; dropping the reader ends the process.
///
/// Every frame of the file is returned once, turned upright, with its own time as stamp (nanoseconds since the
/// start), also for variable frame rates.
#[derive(Debug)]
pub(crate) struct VideoReader {
    process: Arc<Process>,
    pixels: ChildStdout,
    lines: Receiver<FrameLine>,
    complaints: Complaints,
    path: Arc<Path>,
    info: Arc<VideoInfo>,
    max_samples: u64,
    given: u64,
    ended: bool,
}

#[derive(Debug)]
struct Process {
    child: Mutex<Child>,
    interrupted: AtomicBool,
}

impl Process {
    fn kill(&self) {
        let mut child = self.child.lock().unwrap_or_else(PoisonError::into_inner);
        // Both fail only when the process has already ended.
        let _ = child.kill();
        let _ = child.wait();
    }
}

impl VideoReader {
    /// Starts decoding `path`.
    ///
    /// # Errors
    /// `Unsupported` when `ffmpeg` is not installed.
    pub(crate) fn start(
        programs: &Ffmpeg,
        path: Arc<Path>,
        info: VideoInfo,
        max_samples: u64,
    ) -> Result<Self> {
        // Time stamps are read from `showinfo` and then replaced by a constant rate: a raw stream has no time stamps,
        // and ffmpeg would duplicate and drop frames to reach a constant rate.
        let filters = "showinfo=checksum=0,settb=1/25,setpts=N";
        let mut arguments: Vec<_> =
            ["-nostdin", "-nostats", "-hide_banner", "-loglevel", "level+info"].map(Into::into).into();
        arguments.extend(input_arguments(&path, max_samples));
        arguments.extend(["-map", "0:V:0", "-vf", filters, "-r", "25"].map(Into::into));
        arguments.extend(["-f", "rawvideo", "-pix_fmt", "rgb24", "pipe:1"].map(Into::into));
        let mut child = Ffmpeg::spawn(&programs.ffmpeg, &arguments, Stdio::null())?;
        let pipes = child.stdout.take().zip(child.stderr.take());
        let (pixels, errors) = pipes.ok_or_else(|| Error::internal("a child without pipes"))?;
        let (sender, lines) = mpsc::channel();
        let complaints = Complaints::read(errors, move |line| {
            if let Some(frame) = FrameLine::of_text(line) {
                // Sending fails after the reader has been dropped.
                let _ = sender.send(frame);
            }
        });
        let process = Arc::new(Process { child: Mutex::new(child), interrupted: AtomicBool::new(false) });
        let info = Arc::new(info);
        Ok(Self { process, pixels, lines, complaints, path, info, max_samples, given: 0, ended: false })
    }

    fn read(&mut self, line: FrameLine) -> Result<Frame> {
        let FrameLine { width, height, time_s } = line;
        let samples = (width as u64).saturating_mul(height as u64).saturating_mul(3);
        if samples > self.max_samples {
            return Err(Error::invalid_input(format!(
                "frames of {width}x{height} pixels exceed the limit of {} samples; set {LIMIT_VARIABLE} to {samples} or more",
                self.max_samples
            )));
        }
        let mut data = Vec::with_capacity(samples as usize);
        self.pixels.by_ref().take(samples).read_to_end(&mut data)?;
        if data.len() as u64 != samples {
            return Err(self.broken_off());
        }
        let mut image = Image::from_rgb8(data, width, height)?;
        let time_s = time_s.unwrap_or(self.given as f64 / self.info.frame_rate);
        image.header.stamp_ns = Some((time_s * 1e9).round() as i64);
        let path = Arc::clone(&self.path);
        let video = Some(Arc::clone(&self.info));
        Ok(Frame { image, path, item_index: 0, frame_index: self.given, video })
    }

    /// Returns an error unless the video ended normally.
    fn finish(&mut self) -> Result<()> {
        let complaint = self.complaints.finish();
        let status = self.process.child.lock().unwrap_or_else(PoisonError::into_inner).wait()?;
        let short = self.info.frames.is_some_and(|frames| self.given < frames);
        if status.success() && self.given > 0 && !(short && complaint.is_some()) {
            return Ok(());
        }
        let reason = complaint.unwrap_or_else(|| format!("it exited with {status}"));
        Err(self.broken_off().context(format!("ffmpeg reports \"{reason}\"")))
    }

    fn broken_off(&self) -> Error {
        let of = self.info.frames.map_or_else(String::new, |frames| format!(" of {frames}"));
        Error::invalid_input(format!(
            "the video is damaged or truncated after {}{of} frames; copy or download it again",
            self.given
        ))
    }
}

impl Iterator for VideoReader {
    type Item = Result<Frame>;

    fn next(&mut self) -> Option<Result<Frame>> {
        if self.ended {
            return None;
        }
        let frame = match self.lines.recv() {
            Ok(line) => self.read(line),
            Err(_) => match self.finish() {
                Ok(()) => {
                    self.ended = true;
                    return None;
                }
                Err(error) => Err(error),
            },
        };
        self.ended = frame.is_err();
        self.given += 1;
        if self.process.interrupted.load(Ordering::SeqCst) {
            return None;
        }
        Some(frame.context(|| format!("reading {}", self.path.display())))
    }
}

impl FrameReader for VideoReader {
    fn interrupt(&self) -> Box<dyn FnOnce() + Send> {
        let process = Arc::clone(&self.process);
        Box::new(move || {
            process.interrupted.store(true, Ordering::SeqCst);
            process.kill();
        })
    }
}

impl Drop for VideoReader {
    fn drop(&mut self) {
        self.process.kill();
    }
}
