//! The files of a folder, in reading order.

use std::cmp::Ordering;
use std::fs;
use std::path::{Path, PathBuf};

use opendr_engine::{Error, Result, ResultExt};

use crate::source::kind::{FileKind, kind_of_name};

/// Returns the images and videos of `folder`, without subfolders, sorted by name; hidden files are omitted.
///
/// # Errors
/// `Io` when the folder cannot be read, `NotFound` when it contains neither images nor videos.
pub(super) fn files_of_folder(folder: &Path) -> Result<Vec<PathBuf>> {
    let reading = || format!("reading the folder {}", folder.display());
    let mut found = Vec::new();
    let (mut others, mut folders) = (0, 0);
    for entry in fs::read_dir(folder).context(reading)? {
        let path = entry.context(reading)?.path();
        let hidden = path.file_name().is_some_and(|name| name.as_encoded_bytes().starts_with(b"."));
        match kind_of_name(&path) {
            _ if hidden => others += 1,
            Some(FileKind::Picture | FileKind::Video) => found.push(path),
            None if path.is_dir() => folders += 1,
            None => others += 1,
        }
    }
    if found.is_empty() {
        return Err(Error::not_found(format!(
            "no image or video in the folder {} ({others} other files, {folders} folders); for images in \
             subfolders pass a pattern such as \"{}\"",
            folder.display(),
            folder.join("**").join("*.jpg").display()
        )));
    }
    Ok(found)
}

/// Sorts paths in natural order: runs of digits by their value, so that `frame_9` precedes `frame_10`.
pub(super) fn sort_naturally(paths: &mut [PathBuf]) {
    paths.sort_by(|a, b| {
        let [first, second] = [a, b].map(|path| path.as_os_str().as_encoded_bytes());
        natural_order(first, second).then_with(|| first.cmp(second))
    });
}

fn natural_order<'a>(mut a: &'a [u8], mut b: &'a [u8]) -> Ordering {
    loop {
        let (Some(&first), Some(&second)) = (a.first(), b.first()) else { return a.len().cmp(&b.len()) };
        let order = if first.is_ascii_digit() && second.is_ascii_digit() {
            let numbers = [&mut a, &mut b].map(|text| {
                let digits = text.iter().take_while(|byte| byte.is_ascii_digit()).count();
                let (number, rest) = text.split_at(digits);
                *text = rest;
                let zeros = number.iter().take_while(|digit| **digit == b'0').count();
                &number[zeros..]
            });
            numbers[0].len().cmp(&numbers[1].len()).then_with(|| numbers[0].cmp(numbers[1]))
        } else {
            (a, b) = (&a[1..], &b[1..]);
            first.cmp(&second)
        };
        if order.is_ne() {
            return order;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_sort_by_value() {
        let mut paths =
            ["b", "frame_10.png", "frame_9.png", "frame_09.png", "a/frame_100", "frame_", "7", "10"]
                .map(PathBuf::from);
        sort_naturally(&mut paths);
        let wanted = ["7", "10", "a/frame_100", "b", "frame_", "frame_09.png", "frame_9.png", "frame_10.png"];
        assert_eq!(paths, wanted.map(PathBuf::from));
    }

    #[test]
    fn numbers_of_any_length_sort() {
        let long = "9".repeat(1000);
        let mut paths = [PathBuf::from(format!("{long}0")), PathBuf::from(&long)];
        sort_naturally(&mut paths);
        assert_eq!(paths[0], Path::new(&long));
    }
}
