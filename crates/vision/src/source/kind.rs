//! Whether a file is a picture or a video: by its name, else by its first bytes.

use std::fs::File;
use std::io::Read;
use std::path::Path;

use opendr_engine::{Error, Result};

/// What a file is read as.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum FileKind {
    /// One picture.
    Picture,
    /// Frames in time.
    Video,
}

/// Names that people expect to be read; those that are not say so when they are opened.
const PICTURES: [&str; 7] = ["jpg", "jpeg", "png", "bmp", "webp", "tif", "tiff"];

const VIDEOS: [&str; 13] =
    ["mp4", "m4v", "mov", "mkv", "webm", "avi", "mpg", "mpeg", "ts", "flv", "wmv", "ogv", "gif"];

/// What a file is by its extension.
pub(super) fn kind_of_name(path: &Path) -> Option<FileKind> {
    let extension = path.extension()?.to_str()?;
    let is_one = |known: &&str| known.eq_ignore_ascii_case(extension);
    if PICTURES.iter().any(is_one) {
        Some(FileKind::Picture)
    } else if VIDEOS.iter().any(is_one) {
        Some(FileKind::Video)
    } else {
        None
    }
}

/// What a file is by its extension, or else by its first bytes; what is neither is left to the picture decoder,
/// which says what it found.
pub(super) fn kind_of_file(path: &Path) -> FileKind {
    kind_of_name(path).unwrap_or_else(|| {
        let mut head = [0; 12];
        let read = check_is_file(path).and_then(|()| Ok(File::open(path)?.read(&mut head)?)).unwrap_or(0);
        if is_video(&head[..read]) { FileKind::Video } else { FileKind::Picture }
    })
}

fn is_video(head: &[u8]) -> bool {
    let starts =
        [&b"\x1a\x45\xdf\xa3"[..], b"FLV\x01", b"OggS", b"GIF8", b"\x00\x00\x01\xba", b"\x00\x00\x01\xb3"];
    starts.iter().any(|start| head.starts_with(start))
        || head.get(4..8).is_some_and(|brand| brand == b"ftyp" || brand == b"moov")
        || head.starts_with(b"RIFF") && head.get(8..12).is_some_and(|form| form == b"AVI ")
}

/// Refuses what cannot be read to an end, such as a named pipe, before it is opened.
///
/// # Errors
/// `NotFound` or `Io` when the path does not lead to anything, `InvalidInput` when it is not a file.
pub(super) fn check_is_file(path: &Path) -> Result<()> {
    let metadata = std::fs::metadata(path)?;
    if metadata.is_dir() {
        return Err(Error::invalid_input("a folder where a file was expected; give the files in it"));
    }
    if !metadata.is_file() {
        return Err(Error::invalid_input(
            "neither a file nor a folder (a pipe, socket or device); give a file",
        ));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_tell() {
        assert_eq!(kind_of_name(Path::new("a/B.JPEG")), Some(FileKind::Picture));
        assert_eq!(kind_of_name(Path::new("a.b.mp4")), Some(FileKind::Video));
        assert_eq!(kind_of_name(Path::new("jpg")), None);
        assert_eq!(kind_of_name(Path::new("notes.txt")), None);
    }

    #[test]
    fn bytes_tell() {
        assert!(is_video(b"\x00\x00\x00\x20ftypisom"));
        assert!(is_video(b"RIFF\x00\x00\x00\x00AVI "));
        assert!(!is_video(b"RIFF\x00\x00\x00\x00WEBP"));
        assert!(!is_video(b""));
    }
}
