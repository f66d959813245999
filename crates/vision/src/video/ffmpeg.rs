//! The programs `ffmpeg` and `ffprobe`, run as child processes.

use std::ffi::OsString;
use std::io::{BufRead, BufReader, Read};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::{self, JoinHandle};

use opendr_engine::{Error, Result};

/// Containers that are opened. Playlists are excluded: they would make ffmpeg read other files and contact hosts.
const CONTAINERS: &str = "mov,mp4,m4a,3gp,3g2,mj2,matroska,webm,avi,mpeg,mpegts,mpegvideo,h264,hevc,flv,live_flv,asf,ogg,gif,ivf,mjpeg";

/// Maximum line length of a program's output; longer lines are cut.
const MAX_LINE: u64 = 1 << 16;

/// Paths of the programs.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Ffmpeg {
    /// Path of `ffmpeg`.
    pub ffmpeg: PathBuf,
    /// Path of `ffprobe`, which is installed with it.
    pub ffprobe: PathBuf,
}

impl Default for Ffmpeg {
    /// Uses the programs on the search path.
    fn default() -> Self {
        Self { ffmpeg: "ffmpeg".into(), ffprobe: "ffprobe".into() }
    }
}

impl Ffmpeg {
    /// Starts a child process with pipes.
    pub(super) fn spawn(program: &Path, arguments: &[OsString], stdin: Stdio) -> Result<Child> {
        let mut command = Command::new(program);
        command.args(arguments).stdin(stdin).stdout(Stdio::piped()).stderr(Stdio::piped());
        // Ctrl-C in a terminal signals the whole process group; the caller decides what happens to a half-written
        // video.
        #[cfg(unix)]
        std::os::unix::process::CommandExt::process_group(&mut command, 0);
        command.spawn().map_err(|error| {
            if error.kind() != std::io::ErrorKind::NotFound {
                return Error::from(error).context(format!("starting {}", program.display()));
            }
            Error::unsupported(format!(
                "videos need the program ffmpeg, and {} was not found; install it (Debian and Ubuntu: apt install \
                 ffmpeg, macOS: brew install ffmpeg, Windows: winget install ffmpeg)",
                program.display()
            ))
        })
    }
}

/// Returns the arguments of both programs for an untrusted file: no network, no other file, no image of more than
/// `max_samples` RGB samples.
pub(super) fn input_arguments(path: &Path, max_samples: u64) -> Vec<OsString> {
    // The prefix prevents that a name such as `-y` or `concat:a|b` is parsed as an option or a protocol.
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

/// The last error message of a program, kept by a thread that reads its error output.
#[derive(Debug)]
pub(super) struct Complaints {
    last: Arc<Mutex<Option<String>>>,
    thread: Option<JoinHandle<()>>,
}

impl Complaints {
    /// Reads `output` to its end. Lines that begin with or are marked as information are passed to `on_information`;
    /// of the others the last one is kept.
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

    /// Returns the last error message, once the program has closed its error output.
    pub(super) fn finish(&mut self) -> Option<String> {
        if let Some(thread) = self.thread.take() {
            // If the thread failed, only the message is missing.
            let _ = thread.join();
        }
        self.last.lock().unwrap_or_else(PoisonError::into_inner).take()
    }
}

/// Returns the message of a line that `-loglevel level+info` marks as an error, without its origin and level.
fn complaint_of_line(line: &str) -> Option<String> {
    let levels = ["[error] ", "[fatal] ", "[panic] "];
    let start = levels.iter().find_map(|level| line.find(level).map(|at| at + level.len()))?;
    Some(line[start..].trim().to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn last_error_message_is_kept() {
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
