//! Splitting of inputs into segments that one reader reads.

use std::path::{Path, PathBuf};

use opendr_engine::{Error, ErrorKind, Result, ResultExt};

use crate::camera::Camera;
use crate::source::folder::{files_of_folder, sort_naturally};
use crate::source::glob::{files_of_pattern, is_pattern};
use crate::source::kind::{FileKind, check_is_file, kind_of_file};
use crate::source::{SourceOptions, VideoInfo};
use crate::video::{self, Ffmpeg};

/// A part of a source that one reader reads.
#[derive(Debug)]
pub(super) enum Segment {
    /// Image files, in order.
    Pictures(Vec<PathBuf>),
    /// A video file, and its properties or the error of opening it.
    Video(PathBuf, Result<VideoInfo>),
    /// A camera that streams.
    Camera(Box<Camera>),
}

/// Returns the segments of several inputs; consecutive images form one segment.
///
/// # Errors
/// `NotFound` when an input does not exist, or a folder or pattern has no images or videos; `Io` when a folder cannot
/// be read; `Unsupported` when there is a video and `ffmpeg` is not installed; the errors of [`Camera::open`].
pub(super) fn segments_of_inputs<P: AsRef<Path>>(
    inputs: impl IntoIterator<Item = P>,
    options: &SourceOptions,
) -> Result<Vec<Segment>> {
    let mut segments: Vec<Segment> = Vec::new();
    for input in inputs {
        let input = input.as_ref();
        if let Some(device) = camera_of_text(input) {
            segments.push(Segment::Camera(Box::new(Camera::open(&device, options)?)));
            continue;
        }
        for path in files_of_input(input)? {
            match (kind_of_file(&path), segments.last_mut()) {
                (FileKind::Video, _) => {
                    let info = probe_video(&path, options)?;
                    segments.push(Segment::Video(path, info));
                }
                (FileKind::Picture, Some(Segment::Pictures(paths))) => paths.push(path),
                (FileKind::Picture, _) => segments.push(Segment::Pictures(vec![path])),
            }
        }
    }
    if segments.is_empty() {
        return Err(Error::not_found("no input; pass an image, folder, pattern, video or camera"));
    }
    Ok(segments)
}

fn files_of_input(input: &Path) -> Result<Vec<PathBuf>> {
    let mut files = match input.symlink_metadata() {
        Ok(_) if input.is_dir() => files_of_folder(input)?,
        Ok(_) => return Ok(vec![input.to_owned()]),
        Err(_) if is_pattern(input) => files_of_pattern(input)?,
        Err(error) => {
            let what = format!("opening {}", input.display());
            return Err(Error::from(error).context(what));
        }
    };
    sort_naturally(&mut files);
    Ok(files)
}

/// Reads the properties of a video. The outer error means that no video can be read, the inner one that this video
/// cannot.
fn probe_video(path: &Path, options: &SourceOptions) -> Result<Result<VideoInfo>> {
    let info = check_is_file(path)
        .context(|| format!("opening {}", path.display()))
        .and_then(|()| video::probe(&Ffmpeg::default(), path, options.decoder.max_samples));
    match info {
        Err(error) if error.kind() == ErrorKind::Unsupported => Err(error),
        info => Ok(info),
    }
}

/// Returns the device of `camera:N`, `camera:/dev/...` or `/dev/video...`.
fn camera_of_text(input: &Path) -> Option<PathBuf> {
    let text = input.to_str()?;
    match text.strip_prefix("camera:") {
        Some(device) if device.starts_with('/') => Some(PathBuf::from(device)),
        Some(number) => Some(PathBuf::from(format!("/dev/video{number}"))),
        None => text.starts_with("/dev/video").then(|| input.to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn camera_inputs_are_recognised() {
        let device = |text: &str| camera_of_text(Path::new(text));
        assert_eq!(device("camera:0"), Some("/dev/video0".into()));
        assert_eq!(device("camera:/dev/v4l/by-id/x"), Some("/dev/v4l/by-id/x".into()));
        assert_eq!(device("/dev/video3"), Some("/dev/video3".into()));
        assert_eq!(device("camera.jpg"), None);
    }
}
