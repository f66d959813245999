//! Distinction of images and videos, by file name or first bytes.

use std::fs::File;
use std::io::Read;
use std::path::Path;

use opendr_engine::{Error, Result};

/// The kind of a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum FileKind {
    /// One image.
    Picture,
    /// A video.
    Video,
}

/// Extensions of images. Formats that cannot be decoded are included, so that opening them reports an error.
const PICTURES: [&str; 7] = ["jpg", "jpeg", "png", "bmp", "webp", "tif", "tiff"];

const VIDEOS: [&str; 13] =
    ["mp4", "m4v", "mov", "mkv", "webm", "avi", "mpg", "mpeg", "ts", "flv", "wmv", "ogv", "gif"];

/// Returns the kind of a file by its extension.
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

/// Returns the kind of a file by its extension, or else by its first bytes; other files are left to the image
/// decoder, which reports the detected content.
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

/// Rejects paths that are not regular files, such as a named pipe, before they are opened.
///
/// # Errors
/// `NotFound` or `Io` when the path cannot be accessed, `InvalidInput` when it is not a file.
pub(super) fn check_is_file(path: &Path) -> Result<()> {
    let metadata = std::fs::metadata(path)?;
    if metadata.is_dir() {
        return Err(Error::invalid_input("expected a file, but the path is a folder; pass the files in it"));
    }
    if !metadata.is_file() {
        return Err(Error::invalid_input("the path is a pipe, socket or device; pass a file"));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn extensions_determine_the_kind() {
        assert_eq!(kind_of_name(Path::new("a/B.JPEG")), Some(FileKind::Picture));
        assert_eq!(kind_of_name(Path::new("a.b.mp4")), Some(FileKind::Video));
        assert_eq!(kind_of_name(Path::new("jpg")), None);
        assert_eq!(kind_of_name(Path::new("notes.txt")), None);
    }

    #[test]
    fn first_bytes_determine_the_kind() {
        assert!(is_video(b"\x00\x00\x00\x20ftypisom"));
        assert!(is_video(b"RIFF\x00\x00\x00\x00AVI "));
        assert!(!is_video(b"RIFF\x00\x00\x00\x00WEBP"));
        assert!(!is_video(b""));
    }
}
