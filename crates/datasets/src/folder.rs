//! The folder of a data set: names in it, texts in it, and nothing outside it.

use std::fs::{self, File};
use std::io::{Read, Write};
use std::path::{Component, Path, PathBuf};

use opendr_engine::data::Image;
use opendr_engine::{Error, Result, ResultExt};
use opendr_vision::Encoder;

use crate::Problem;

/// At which a picture that is written anew loses next to nothing.
const JPEG_QUALITY: u8 = 95;
/// The longest text that is read whole: lists and labels, not bulk data.
const MAX_TEXT_BYTES: u64 = 256 << 20;
/// Names a folder may have before it is refused: ImageNet's training part has 1.3 million pictures in all.
const MAX_NAMES: usize = 16 << 20;

/// `name`, written in a file of the data set, as a path in `folder`; what is wrong with it otherwise.
pub(crate) fn path_inside(folder: &Path, name: &str) -> Result<PathBuf, String> {
    let relative = Path::new(name);
    let mut parts = relative.components();
    let inside = parts.all(|part| matches!(part, Component::Normal(_) | Component::CurDir));
    // A backslash separates folders on Windows only; there and here it means no good.
    if !inside || name.is_empty() || name.contains(['\\', '\0']) {
        return Err(format!(
            "the file name {name:.80?} leaves the folder of the data set; write it relative to it"
        ));
    }
    Ok(folder.join(relative))
}

/// The names in `folder` that are not hidden, in order; those that are no Unicode are left out.
///
/// # Errors
/// `NotFound` or `Io` when it cannot be read.
pub(crate) fn names_in(folder: &Path) -> Result<Vec<String>> {
    let reading = || format!("reading the folder {}", folder.display());
    let mut names = Vec::new();
    for entry in fs::read_dir(folder).context(reading)? {
        let name = entry.context(reading)?.file_name();
        names.extend(name.into_string().ok().filter(|name| !name.starts_with('.')));
        if names.len() > MAX_NAMES {
            return Err(Error::invalid_input(format!("over {MAX_NAMES} names; divide it")).context(reading()));
        }
    }
    names.sort_unstable();
    Ok(names)
}

/// The names of the folders in `folder`; none when it cannot be read.
pub(crate) fn folders_in(folder: &Path) -> Vec<String> {
    let mut names = names_in(folder).unwrap_or_default();
    names.retain(|name| folder.join(name).is_dir());
    names
}

/// The names in `folder` with one of `extensions` (in lower case); none when it cannot be read.
pub(crate) fn files_in(folder: &Path, extensions: &[&str]) -> Vec<String> {
    let mut names = names_in(folder).unwrap_or_default();
    names.retain(|name| has_extension(name, extensions));
    names
}

/// Whether `name` ends in one of `extensions` (in lower case).
pub(crate) fn has_extension(name: &str, extensions: &[&str]) -> bool {
    name.rsplit_once('.').is_some_and(|(_, extension)| extensions.contains(&&*extension.to_lowercase()))
}

/// The folder of the part `wanted` in `root`; without one, the first of `usual` that is there, or `None`.
///
/// # Errors
/// `NotFound` when there is no part called `wanted`, with those that there are.
pub(crate) fn part_folder(root: &Path, wanted: Option<&str>, usual: &[&str]) -> Result<Option<PathBuf>> {
    let Some(wanted) = wanted else {
        return Ok(usual.iter().map(|name| root.join(name)).find(|folder| folder.is_dir()));
    };
    path_inside(root, wanted).ok().filter(|folder| folder.is_dir()).map(Some).ok_or_else(|| {
        let there = folders_in(root).join(", ");
        Error::not_found(format!("no part {wanted:.80?} in {}; there are {there}", root.display()))
    })
}

/// Extensions of pictures that are read.
pub(crate) const PICTURES: &[&str] = &["jpg", "jpeg", "png", "bmp", "webp"];

/// The whole text of a file.
///
/// # Errors
/// `NotFound` or `Io` when it cannot be read; `Format` when it is no UTF-8, or too long for a text.
pub(crate) fn read_text(path: &Path) -> Result<String> {
    let bytes = read_bytes(path, MAX_TEXT_BYTES)?;
    // A byte order mark is no part of the first field.
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").map(<[u8]>::to_vec).unwrap_or(bytes);
    String::from_utf8(bytes).map_err(|error| {
        let byte = error.utf8_error().valid_up_to() as u64;
        Problem::at_byte(path, byte, "is no UTF-8 text; save it as such").into()
    })
}

/// All bytes of a file of at most `limit` bytes.
///
/// # Errors
/// `NotFound` or `Io` when it cannot be read; `Format` when it is longer.
pub(crate) fn read_bytes(path: &Path, limit: u64) -> Result<Vec<u8>> {
    let mut bytes = Vec::new();
    let read = File::open(path).and_then(|file| file.take(limit + 1).read_to_end(&mut bytes));
    read.context(|| format!("reading {}", path.display()))?;
    if bytes.len() as u64 > limit {
        return Err(Problem::new(path, format!("is over {limit} bytes; divide it")).into());
    }
    Ok(bytes)
}

/// Writes a file, whole or not at all, and the folders above it.
///
/// # Errors
/// `Io` when it cannot be written.
pub(crate) fn write_file(path: &Path, bytes: &[u8]) -> Result<()> {
    let write = || {
        if let Some(folder) = path.parent() {
            fs::create_dir_all(folder)?;
        }
        let mut unfinished = path.as_os_str().to_owned();
        unfinished.push(".part");
        File::create(&unfinished)?.write_all(bytes)?;
        fs::rename(&unfinished, path)
    };
    write().context(|| format!("writing {}", path.display()))
}

/// Puts a picture at `to`: a copy of the file `from` (a hard link, if wished) where that is of the same format, else
/// `image`, encoded well.
///
/// # Errors
/// `Io` when it cannot be written.
pub(crate) fn write_picture(from: Option<&Path>, image: &Image, to: &Path, link: bool) -> Result<()> {
    let extension = |path: &Path| path.extension().map(|extension| extension.to_ascii_lowercase());
    let same = from.filter(|from| extension(from) == extension(to));
    if let Some(folder) = to.parent() {
        fs::create_dir_all(folder).context(|| format!("writing {}", to.display()))?;
    }
    let Some(from) = same else { return Encoder { jpeg_quality: JPEG_QUALITY }.save(image, to) };
    if link && fs::hard_link(from, to).is_ok() {
        return Ok(());
    }
    fs::copy(from, to).context(|| format!("copying {} to {}", from.display(), to.display()))?;
    Ok(())
}

/// The last part of a path, for names and messages.
pub(crate) fn name_of(path: &Path) -> String {
    path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned()
}

/// The error for a sample past the end.
#[cold]
pub(crate) fn past_end(index: usize, len: usize) -> Error {
    Error::not_found(format!("no sample {index} in a data set of {len}"))
}

#[cfg(test)]
mod temporary;

#[cfg(test)]
pub(crate) use temporary::{TemporaryFolder, real_data};

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_stay_inside() {
        let folder = Path::new("set");
        assert_eq!(path_inside(folder, "a/./b.png").unwrap(), Path::new("set/a/./b.png"));
        for name in ["../a", "a/../../b", "/etc/passwd", "", "a\\..\\b", "a\0b"] {
            assert!(path_inside(folder, name).is_err(), "{name:?}");
        }
    }

    #[test]
    fn texts_are_bounded_and_unicode() {
        let path = std::env::temp_dir().join(format!("opendr-folder-{}.txt", std::process::id()));
        write_file(&path, b"\xef\xbb\xbf1 2").unwrap();
        assert_eq!(read_text(&path).unwrap(), "1 2");
        write_file(&path, b"1 \xff").unwrap();
        assert!(read_text(&path).unwrap_err().to_string().contains("at byte 2: is no UTF-8"));
        assert!(read_bytes(&path, 2).unwrap_err().to_string().contains("is over 2 bytes"));
        fs::remove_file(path).unwrap();
    }
}
