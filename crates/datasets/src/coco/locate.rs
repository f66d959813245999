//! Location of the files of a COCO data set.

use std::fs::{self, File};
use std::io::Read;
use std::path::{Path, PathBuf};

use opendr_engine::{Error, Result};

/// Parts of a data set; the first existing one is used.
const SPLITS: [&str; 6] = ["val", "valid", "validation", "test", "minival", "train"];

/// Bytes read to recognise a file.
const HEAD: u64 = 1 << 16;

/// Returns whether the name of a file has one of these beginnings.
pub(super) fn name_begins(file: &Path, beginnings: &[&str]) -> bool {
    let name = file.file_name().unwrap_or_default().to_string_lossy();
    beginnings.iter().any(|beginning| name.starts_with(beginning))
}

/// Returns the sorted annotation files at `path`: itself, those of its folder `annotations`, its own, or (as
/// exported by Roboflow) those of its parts.
pub(super) fn annotation_files(path: &Path) -> Vec<PathBuf> {
    if path.is_file() {
        return if is_json(path) { vec![path.to_owned()] } else { Vec::new() };
    }
    let inside = [path.join("annotations"), path.to_owned()];
    let parts = SPLITS.iter().map(|split| path.join(split).join("_annotations.coco.json"));
    let found = inside.iter().map(|folder| json_files(folder)).find(|files| !files.is_empty());
    found.unwrap_or_else(|| parts.filter(|file| file.is_file()).collect())
}

fn json_files(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    let mut files: Vec<_> = entries.map(|entry| entry.path()).filter(|file| is_json(file)).collect();
    files.sort();
    files
}

fn is_json(file: &Path) -> bool {
    file.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("json")) && file.is_file()
}

/// Returns the part of an annotation file: `instances_val2017.json` is of `val2017`.
pub(super) fn split_of(file: &Path) -> String {
    let stem = file.file_stem().unwrap_or_default().to_string_lossy();
    if stem == "_annotations.coco" {
        let folder = file.parent().and_then(Path::file_name).unwrap_or_default();
        return folder.to_string_lossy().into_owned();
    }
    let kinds = ["instances_", "person_keypoints_", "panoptic_", "captions_", "image_info_", "stuff_"];
    let split = kinds.iter().find_map(|kind| stem.strip_prefix(kind));
    split.unwrap_or(&stem).to_owned()
}

/// Returns the file of `split`. By default, returns the only one, or that of val, test or train; of several kinds,
/// the first.
pub(super) fn choose<'a>(files: &'a [PathBuf], split: Option<&str>, kinds: &[&str]) -> Result<&'a PathBuf> {
    let kind = |file: &Path| {
        let name = file.file_name().unwrap_or_default().to_string_lossy();
        kinds.iter().position(|kind| name.starts_with(kind)).unwrap_or(kinds.len())
    };
    let best = |wanted: &dyn Fn(&str) -> bool| {
        files.iter().filter(|file| wanted(&split_of(file))).min_by_key(|file| kind(file))
    };
    let found = match split {
        Some(split) => best(&|name| name == split).or_else(|| {
            best(&|name| name.starts_with(split) && !name[split.len()..].starts_with(char::is_alphabetic))
        }),
        None => SPLITS
            .iter()
            .find_map(|split| best(&|name| name.starts_with(split)))
            .or_else(|| files.iter().min_by_key(|file| kind(file))),
    };
    found.ok_or_else(|| {
        let mut splits: Vec<_> = files.iter().map(|file| split_of(file)).collect();
        splits.dedup();
        let (wanted, there) = (split.unwrap_or("any"), splits.join(", "));
        Error::not_found(format!("no annotation file of the part {wanted:?}; the parts are: {there}"))
    })
}

/// Returns whether a file starts with an object that has one of `keys`.
pub(super) fn begins_with_key(file: &Path, keys: &[&str]) -> bool {
    let text = head(file);
    text.starts_with('{') && keys.iter().any(|key| text.contains(&format!("\"{key}\"")))
}

/// Returns whether a file contains a list, as files of results do.
pub(super) fn begins_as_list(file: &Path) -> bool {
    head(file).starts_with('[')
}

/// Returns the first bytes of a file; empty if it cannot be read.
fn head(file: &Path) -> String {
    let mut bytes = Vec::new();
    let read = File::open(file).and_then(|file| file.take(HEAD).read_to_end(&mut bytes));
    let text = if read.is_ok() { String::from_utf8_lossy(&bytes).into_owned() } else { String::new() };
    text.trim_start_matches('\u{feff}').trim_start().to_owned()
}

/// Returns the folder of the image `name` of the annotation file `file`; the most likely folder if none contains
/// it.
pub(super) fn picture_folder(root: &Path, file: &Path, name: &Path) -> PathBuf {
    let split = split_of(file);
    let beside = file.parent().unwrap_or(Path::new(""));
    let root = if root.is_file() { beside } else { root };
    let above = if beside.ends_with("annotations") { beside.parent().unwrap_or(root) } else { root };
    let folders = [
        above.join(&split),
        above.join("images").join(&split),
        above.join("images"),
        beside.to_owned(),
        above.to_owned(),
        above.join("../images").join(&split),
    ];
    let found = folders.iter().find(|folder| folder.join(name).is_file());
    found.unwrap_or(&folders[0]).clone()
}
