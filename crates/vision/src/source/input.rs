//! What a user names as input, sorted into what can be read in one go.

use std::path::{Path, PathBuf};

use opendr_engine::{Error, Result};

use crate::source::folder::{files_of_folder, sort_naturally};
use crate::source::glob::{files_of_pattern, is_pattern};
use crate::source::kind::{FileKind, kind_of_file};

/// A part of a source that one reader reads.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Segment {
    /// Picture files, in order.
    Pictures(Vec<PathBuf>),
    /// A video file.
    Video(PathBuf),
    /// A camera device.
    Camera(PathBuf),
}

/// The segments of several inputs; pictures that follow each other make one segment.
///
/// # Errors
/// `NotFound` when an input does not exist, or a folder or pattern holds nothing to read; `Io` when a folder cannot be
/// read.
pub(super) fn segments_of_inputs<P: AsRef<Path>>(
    inputs: impl IntoIterator<Item = P>,
) -> Result<Vec<Segment>> {
    let mut segments: Vec<Segment> = Vec::new();
    for input in inputs {
        let input = input.as_ref();
        if let Some(device) = camera_of_text(input) {
            segments.push(Segment::Camera(device));
            continue;
        }
        for path in files_of_input(input)? {
            match (kind_of_file(&path), segments.last_mut()) {
                (FileKind::Video, _) => segments.push(Segment::Video(path)),
                (FileKind::Picture, Some(Segment::Pictures(paths))) => paths.push(path),
                (FileKind::Picture, _) => segments.push(Segment::Pictures(vec![path])),
            }
        }
    }
    if segments.is_empty() {
        return Err(Error::not_found("no input; give a picture, folder, pattern, video or camera"));
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

/// The device of `camera:N`, `camera:/dev/...` or `/dev/video...`.
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
    fn cameras_are_known_by_their_text() {
        let device = |text: &str| camera_of_text(Path::new(text));
        assert_eq!(device("camera:0"), Some("/dev/video0".into()));
        assert_eq!(device("camera:/dev/v4l/by-id/x"), Some("/dev/v4l/by-id/x".into()));
        assert_eq!(device("/dev/video3"), Some("/dev/video3".into()));
        assert_eq!(device("camera.jpg"), None);
    }
}
