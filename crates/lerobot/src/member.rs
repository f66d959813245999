//! Paths within a data set.

use std::path::{Component, Path, PathBuf};

use opendr_engine::{Error, Result};

/// Returns the path of a pattern such as `data/chunk-{chunk_index:03d}/file-{file_index:03d}.parquet`.
///
/// # Errors
/// `Format` for a placeholder that is not known, and for a path that leaves the data set.
pub(crate) fn member(root: &Path, pattern: &str, numbers: &[(&str, usize)], key: &str) -> Result<PathBuf> {
    let unknown = || Error::format(format!("{pattern:.200?} is no pattern of paths of LeRobot"));
    let (mut path, mut rest) = (String::new(), pattern);
    while let Some((before, after)) = rest.split_once('{') {
        let (field, behind) = after.split_once('}').ok_or_else(unknown)?;
        path.push_str(before);
        let (name, width) = field.split_once(':').unwrap_or((field, ""));
        match numbers.iter().find(|(known, _)| *known == name) {
            Some((_, number)) => {
                let width: usize = width.trim_end_matches('d').parse().unwrap_or(0);
                path.push_str(&format!("{number:0width$}", width = width.min(20)));
            }
            None if name == "video_key" => path.push_str(key),
            None => return Err(unknown()),
        }
        rest = behind;
    }
    path.push_str(rest);
    let inside = Path::new(&path).components().all(|part| matches!(part, Component::Normal(_)));
    if !inside || path.contains('\0') {
        return Err(Error::format(format!("{path:.200?} is no path within the data set")));
    }
    Ok(root.join(path))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn patterns_are_filled_in() {
        let pattern = "videos/{video_key}/chunk-{chunk_index:03d}/file-{file_index:03d}.mp4";
        let numbers = [("chunk_index", 2), ("file_index", 1234)];
        let path = member(Path::new("/set"), pattern, &numbers, "observation.image").unwrap();
        assert_eq!(path, Path::new("/set/videos/observation.image/chunk-002/file-1234.mp4"));
    }

    #[test]
    fn no_path_leaves_the_set() {
        for (pattern, key) in [
            ("../{video_key}", "a"),
            ("/etc/{video_key}", "a"),
            ("{video_key}/x", "../.."),
            ("{other}", ""),
            ("{x", ""),
        ] {
            assert!(member(Path::new("/set"), pattern, &[], key).is_err(), "{pattern}");
        }
    }
}
