//! File name patterns: `*`, `?`, `[a-z]`, `[!a-z]`, and `**` for any number of folders.
//!
//! Patterns match bytes, so that names that are not UTF-8 match too.

use std::ffi::OsStr;
use std::fs;
use std::path::{Component, Path, PathBuf};

use opendr_engine::{Error, Result};

/// Maximum depth of `**`; symbolic links to folders are not followed.
const MAX_DEPTH: usize = 64;

/// Returns whether `path` has a character that is special in patterns.
pub(super) fn is_pattern(path: &Path) -> bool {
    path.as_os_str().as_encoded_bytes().iter().any(|byte| b"*?[".contains(byte))
}

/// Returns the files that match `pattern`, unsorted. As in a shell, names that begin with a full stop match only a
/// pattern that begins with one.
///
/// # Errors
/// `NotFound` when nothing matches.
pub(super) fn files_of_pattern(pattern: &Path) -> Result<Vec<PathBuf>> {
    let mut parts: Vec<&OsStr> = Vec::new();
    let mut root = PathBuf::new();
    for component in pattern.components() {
        match component {
            Component::Normal(name) if !parts.is_empty() || is_pattern(Path::new(name)) => parts.push(name),
            other if parts.is_empty() => root.push(other),
            other => parts.push(other.as_os_str()),
        }
    }
    let mut found = Vec::new();
    walk(&root, &parts, 0, &mut found);
    found.sort();
    found.dedup();
    if found.is_empty() {
        return Err(Error::not_found(format!(
            "no file matches \"{}\" (searched in {}); check the pattern, and quote it so that the shell does not expand it",
            pattern.display(),
            if root.as_os_str().is_empty() { "the current folder".into() } else { root.to_string_lossy() },
        )));
    }
    Ok(found)
}

fn walk(folder: &Path, parts: &[&OsStr], depth: usize, found: &mut Vec<PathBuf>) {
    let Some((part, rest)) = parts.split_first() else {
        if !folder.is_dir() {
            found.push(folder.to_owned());
        }
        return;
    };
    let pattern = part.as_encoded_bytes();
    let any_folders = pattern == b"**";
    if any_folders && !rest.is_empty() {
        walk(folder, rest, depth, found);
    }
    if !any_folders && !is_pattern(Path::new(part)) {
        let next = folder.join(part);
        if next.symlink_metadata().is_ok() {
            walk(&next, rest, depth, found);
        }
        return;
    }
    let here = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    for entry in fs::read_dir(here).into_iter().flatten().flatten() {
        let name = entry.file_name();
        let bytes = name.as_encoded_bytes();
        if bytes.starts_with(b".") && !pattern.starts_with(b".") {
            continue;
        }
        let path = folder.join(&name);
        if any_folders {
            let real_folder = entry.file_type().is_ok_and(|kind| kind.is_dir());
            if real_folder && depth < MAX_DEPTH {
                walk(&path, parts, depth + 1, found);
            } else if rest.is_empty() {
                walk(&path, rest, depth, found);
            }
        } else if matches(pattern, bytes) {
            walk(&path, rest, depth, found);
        }
    }
}

/// Returns whether `name` matches `pattern`. Greedy with one backtracking point: linear in practice, quadratic in the
/// worst case.
fn matches(pattern: &[u8], name: &[u8]) -> bool {
    let (mut p, mut n) = (0, 0);
    let mut retry: Option<(usize, usize)> = None;
    while n < name.len() {
        let step = match pattern.get(p) {
            Some(b'*') => {
                retry = Some((p + 1, n));
                p += 1;
                continue;
            }
            Some(b'?') => Some(character_length(&name[n..])).map(|length| (1, length)),
            Some(b'[') => match class_matches(&pattern[p..], name[n]) {
                Some((length, true)) => Some((length, 1)),
                Some((_, false)) => None,
                None => (name[n] == b'[').then_some((1, 1)),
            },
            Some(byte) => (*byte == name[n]).then_some((1, 1)),
            None => None,
        };
        match (step, retry) {
            (Some((in_pattern, in_name)), _) => (p, n) = (p + in_pattern, n + in_name),
            (None, Some((after_star, from))) => {
                (p, n) = (after_star, from + 1);
                retry = Some((after_star, from + 1));
            }
            (None, None) => return false,
        }
    }
    pattern[p..].iter().all(|byte| *byte == b'*')
}

/// Returns the length in bytes of the first UTF-8 character of `name`; 1 for an invalid one.
fn character_length(name: &[u8]) -> usize {
    1 + name[1..].iter().take(3).take_while(|byte| name[0] >= 0xc0 && **byte & 0xc0 == 0x80).count()
}

/// Returns the length of the character class at the start of `pattern` and whether it contains `byte`; `None` when it
/// is not closed.
fn class_matches(pattern: &[u8], byte: u8) -> Option<(usize, bool)> {
    let negated = matches!(pattern.get(1), Some(b'!' | b'^'));
    let first = if negated { 2 } else { 1 };
    // A closing bracket in first position is a member.
    let end = first + 1 + pattern.get(first + 1..)?.iter().position(|byte| *byte == b']')?;
    let mut members = &pattern[first..end];
    let mut found = false;
    while let Some((&low, rest)) = members.split_first() {
        let (high, after) = match rest {
            [b'-', high, after @ ..] => (*high, after),
            _ => (low, rest),
        };
        found |= (low..=high).contains(&byte);
        members = after;
    }
    Some((end + 1, found != negated))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn patterns_match_as_in_a_shell() {
        let cases = [
            ("*.jpg", "a.jpg", true),
            ("*.jpg", "a.jpeg", false),
            ("*", "", true),
            ("a*b*c", "axxbyyc", true),
            ("a*b*c", "axxbyy", false),
            ("frame_??.png", "frame_07.png", true),
            ("frame_??.png", "frame_7.png", false),
            ("?.png", "ü.png", true),
            ("[a-c]1", "b1", true),
            ("[!a-c]1", "b1", false),
            ("[]x]", "]", true),
            ("[abc", "[abc", true),
            ("**", "anything", true),
        ];
        for (pattern, name, wanted) in cases {
            assert_eq!(matches(pattern.as_bytes(), name.as_bytes()), wanted, "{pattern} {name}");
        }
        assert!(matches(b"*.jpg", b"\xff\xfe.jpg"));
    }

    #[test]
    fn hostile_pattern_takes_no_exponential_time() {
        let pattern = "*a".repeat(200) + "b";
        assert!(!matches(pattern.as_bytes(), "a".repeat(4000).as_bytes()));
    }
}
