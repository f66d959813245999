//! The programs that know every video format, run as child processes.

use std::ffi::OsString;
use std::io::{BufRead, BufReader, Read};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::{self, JoinHandle};

use opendr_engine::{Error, Result};

/// Containers that are opened. Playlists are not: a file of a few lines would have other files read and hosts asked.
const CONTAINERS: &str = "mov,mp4,m4a,3gp,3g2,mj2,matroska,webm,avi,mpeg,mpegts,mpegvideo,h264,hevc,flv,live_flv,asf,ogg,gif,ivf,mjpeg";

/// Longer lines of a program are cut here.
const MAX_LINE: u64 = 1 << 16;

/// Where the programs are.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Ffmpeg {
    /// `ffmpeg`.
    pub ffmpeg: PathBuf,
    /// `ffprobe`, which comes with it.
    pub ffprobe: PathBuf,
}

impl Default for Ffmpeg {
    /// Those that the search path leads to.
    fn default() -> Self {
        Self { ffmpeg: "ffmpeg".into(), ffprobe: "ffprobe".into() }
    }
}

impl Ffmpeg {
    /// A child that writes to pipes.
    pub(super) fn spawn(program: &Path, arguments: &[OsString], stdin: Stdio) -> Result<Child> {
        let mut command = Command::new(program);
        command.args(arguments).stdin(stdin).stdout(Stdio::piped()).stderr(Stdio::piped());
        // Ctrl-C in a terminal goes to the whole group: the program then decides what becomes of a half-written video.
        #[cfg(unix)]
        std::os::unix::process::CommandExt::process_group(&mut command, 0);
        command.spawn().map_err(|error| {
            if error.kind() != std::io::ErrorKind::NotFound {
                return Error::from(error).context(format!("starting {}", program.display()));
            }
            Error::unsupported(format!(
                "videos take the program ffmpeg, and {} was not found; install it (Debian and Ubuntu: apt install \
                 ffmpeg, macOS: brew install ffmpeg, Windows: winget install ffmpeg)",
                program.display()
            ))
        })
    }
}

/// What both programs are told of a file from outside: no network, no other file, no picture of more than
/// `max_samples` RGB samples.
pub(super) fn input_arguments(path: &Path, max_samples: u64) -> Vec<OsString> {
    // The prefix keeps a name such as `-y` or `concat:a|b` a name.
    let mut file = OsString::from("file:");
    file.push(path);
    let max_pixels = (max_samples / 3).to_string();
    let mut arguments: Vec<OsString> =
        ["-protocol_whitelist", "file", "-format_whitelist", CONTAINERS, "-max_pixels", &max_pixels, "-i"]
            .map(OsString::from)
            .into();
    arguments.push(file);
    arguments
}

/// The last complaint of a program, kept by a thread that reads its error output.
#[derive(Debug)]
pub(super) struct Complaints {
    last: Arc<Mutex<Option<String>>>,
    thread: Option<JoinHandle<()>>,
}

impl Complaints {
    /// Reads `output` to its end. Lines that begin or are marked as information go to `on_information`, the last of
    /// the others is kept.
    pub(super) fn read(
        output: impl Read + Send + 'static,
        mut on_information: impl FnMut(&str) + Send + 'static,
    ) -> Self {
        let last = Arc::new(Mutex::new(None));
        let kept = Arc::clone(&last);
        let thread = thread::spawn(move || {
            let mut output = BufReader::new(output);
            let mut line = Vec::new();
            while output.by_ref().take(MAX_LINE).read_until(b'\n', &mut line).is_ok_and(|read| read > 0) {
                let text = String::from_utf8_lossy(&line);
                match complaint_of_line(&text) {
                    Some(complaint) => {
                        *kept.lock().unwrap_or_else(PoisonError::into_inner) = Some(complaint);
                    }
                    None => on_information(&text),
                }
                line.clear();
            }
        });
        Self { last, thread: Some(thread) }
    }

    /// The last complaint, once the program has closed its error output.
    pub(super) fn finish(&mut self) -> Option<String> {
        if let Some(thread) = self.thread.take() {
            // Without the thread's last words the error is only less clear.
            let _ = thread.join();
        }
        self.last.lock().unwrap_or_else(PoisonError::into_inner).take()
    }
}

/// The message of a line that `-loglevel level+info` marks as an error: without its origin and level.
fn complaint_of_line(line: &str) -> Option<String> {
    let levels = ["[error] ", "[fatal] ", "[panic] "];
    let start = levels.iter().find_map(|level| line.find(level).map(|at| at + level.len()))?;
    Some(line[start..].trim().to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn last_complaint_is_kept() {
        let output = "[info] a\n[h264 @ 0x5] [error] first\n[fatal] file:x: Invalid data \nplain\n";
        let mut complaints = Complaints::read(output.as_bytes(), |_| {});
        assert_eq!(complaints.finish().as_deref(), Some("file:x: Invalid data"));
    }

    #[test]
    fn missing_program_says_what_to_do() {
        let error = Ffmpeg::spawn(Path::new("/no/such/ffmpeg"), &[], Stdio::null()).unwrap_err();
        assert_eq!(error.kind(), opendr_engine::ErrorKind::Unsupported);
        assert!(error.to_string().contains("apt install ffmpeg"), "{error}");
    }
}
