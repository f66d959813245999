//! Access to the files of a data set, limited to its folder.

use std::fs::{self, File};
use std::io::Read;
use std::path::{Component, Path, PathBuf};

use opendr_engine::atomic_file::replace_file;
use opendr_engine::data::Image;
use opendr_engine::{Error, Result, ResultExt};
use opendr_vision::Encoder;

use crate::Problem;

/// JPEG quality of images that are encoded again.
const JPEG_QUALITY: u8 = 95;
/// Largest size of a text file in bytes.
const MAX_TEXT_BYTES: u64 = 256 << 20;
/// Largest number of names in a folder: the training part of ImageNet has 1.3 million images in all.
const MAX_NAMES: usize = 16 << 20;

/// Returns the path of `name`, as written in a file of the data set, in `folder`; an error if it leaves the folder.
pub(crate) fn path_inside(folder: &Path, name: &str) -> Result<PathBuf, String> {
    let relative = Path::new(name);
    let mut parts = relative.components();
    let inside = parts.all(|part| matches!(part, Component::Normal(_) | Component::CurDir));
    // A backslash separates folders on Windows only, and is rejected everywhere.
    if !inside || name.is_empty() || name.contains(['\\', '\0']) {
        return Err(format!(
            "the file name {name:.80?} is outside of the folder of the data set; write it relative to that folder"
        ));
    }
    Ok(folder.join(relative))
}

/// Returns the sorted names in `folder` without hidden files; names that are not Unicode are skipped.
///
/// # Errors
/// `NotFound` or `Io` if it cannot be read.
pub(crate) fn names_in(folder: &Path) -> Result<Vec<String>> {
    let reading = || format!("reading the folder {}", folder.display());
    let mut names = Vec::new();
    for entry in fs::read_dir(folder).context(reading)? {
        let name = entry.context(reading)?.file_name();
        names.extend(name.into_string().ok().filter(|name| !name.starts_with('.')));
        if names.len() > MAX_NAMES {
            return Err(Error::invalid_input(format!("the folder has over {MAX_NAMES} names; split it"))
                .context(reading()));
        }
    }
    names.sort_unstable();
    Ok(names)
}

/// Returns the names of the folders in `folder`; empty if it cannot be read.
pub(crate) fn folders_in(folder: &Path) -> Vec<String> {
    let mut names = names_in(folder).unwrap_or_default();
    names.retain(|name| folder.join(name).is_dir());
    names
}

/// Returns the names in `folder` with one of `extensions` (in lower case); empty if it cannot be read.
pub(crate) fn files_in(folder: &Path, extensions: &[&str]) -> Vec<String> {
    let mut names = names_in(folder).unwrap_or_default();
    names.retain(|name| has_extension(name, extensions));
    names
}

/// Returns whether `name` ends with one of `extensions` (in lower case).
pub(crate) fn has_extension(name: &str, extensions: &[&str]) -> bool {
    name.rsplit_once('.').is_some_and(|(_, extension)| extensions.contains(&&*extension.to_lowercase()))
}

/// Returns the folder of the part `wanted` in `root`; without a part, the first existing one of `usual`, or `None`.
///
/// # Errors
/// `NotFound` if there is no part `wanted`, with the list of parts.
pub(crate) fn part_folder(root: &Path, wanted: Option<&str>, usual: &[&str]) -> Result<Option<PathBuf>> {
    let Some(wanted) = wanted else {
        return Ok(usual.iter().map(|name| root.join(name)).find(|folder| folder.is_dir()));
    };
    path_inside(root, wanted).ok().filter(|folder| folder.is_dir()).map(Some).ok_or_else(|| {
        let there = folders_in(root).join(", ");
        Error::not_found(format!("no part {wanted:.80?} in {}; there are {there}", root.display()))
    })
}

/// File extensions of images.
pub(crate) const PICTURES: &[&str] = &["jpg", "jpeg", "png", "bmp", "webp"];

/// Reads a text file.
///
/// # Errors
/// `NotFound` or `Io` if it cannot be read; `Format` if it is not UTF-8 or too long.
pub(crate) fn read_text(path: &Path) -> Result<String> {
    let bytes = read_bytes(path, MAX_TEXT_BYTES)?;
    // A byte order mark is not part of the first field.
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").map(<[u8]>::to_vec).unwrap_or(bytes);
    String::from_utf8(bytes).map_err(|error| {
        let byte = error.utf8_error().valid_up_to() as u64;
        Problem::at_byte(path, byte, "is not UTF-8 text; save the file as UTF-8").into()
    })
}

/// Reads a file of at most `limit` bytes.
///
/// # Errors
/// `NotFound` or `Io` if it cannot be read; `Format` if it is longer.
pub(crate) fn read_bytes(path: &Path, limit: u64) -> Result<Vec<u8>> {
    let mut bytes = Vec::new();
    let read = File::open(path).and_then(|file| file.take(limit + 1).read_to_end(&mut bytes));
    read.context(|| format!("reading {}", path.display()))?;
    if bytes.len() as u64 > limit {
        return Err(Problem::new(path, format!("is over {limit} bytes; split the file")).into());
    }
    Ok(bytes)
}

/// Writes a file atomically, and creates its parent folders.
///
/// # Errors
/// `Io` if it cannot be written.
pub(crate) fn write_file(path: &Path, bytes: &[u8]) -> Result<()> {
    if let Some(folder) = path.parent() {
        fs::create_dir_all(folder).context(|| format!("writing {}", path.display()))?;
    }
    replace_file(path, bytes)
}

/// Writes an image to `to`: as a copy of the file `from` (a hard link if `link`) if it has the same format,
/// otherwise by encoding `image`.
///
/// # Errors
/// `Io` if it cannot be written.
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

/// Returns the last part of a path, for names and messages.
pub(crate) fn name_of(path: &Path) -> String {
    path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned()
}

/// Returns the error for a sample index past the end.
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
        assert!(read_text(&path).unwrap_err().to_string().contains("at byte 2: is not UTF-8"));
        assert!(read_bytes(&path, 2).unwrap_err().to_string().contains("is over 2 bytes"));
        fs::remove_file(path).unwrap();
    }
}
