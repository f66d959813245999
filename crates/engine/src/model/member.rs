//! Names of files in containers and archives of unknown origin.

use std::path::PathBuf;

use crate::{Error, Result};

/// Returns the relative path of a member. Its name has forward slashes, and the path never leaves its folder on any
/// system.
///
/// # Errors
/// Returns `Integrity` for a name that is empty or absolute, or contains `..`, a backslash, a colon (Windows drives and
/// streams) or a control character.
pub fn member_path(name: &str) -> Result<PathBuf> {
    let allowed = |part: &str| {
        !matches!(part, "" | "." | "..")
            && !part.ends_with(['.', ' '])
            && !part.contains(|c: char| c == '\\' || c == ':' || c.is_control())
    };
    if name.len() <= 1024 && name.split('/').all(allowed) {
        return Ok(name.split('/').collect());
    }
    let excerpt: String = name.chars().take(80).collect();
    Err(Error::integrity(format!(
        "the file name {excerpt:?} could leave its folder; use plain relative names with forward slashes"
    )))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ErrorKind;

    #[test]
    fn names_stay_inside() {
        assert_eq!(member_path("model.onnx").unwrap(), PathBuf::from("model.onnx"));
        assert_eq!(
            member_path("package/models/a.bin").unwrap(),
            ["package", "models", "a.bin"].iter().collect::<PathBuf>()
        );
        for name in [
            "",
            ".",
            "..",
            "../x",
            "../../x",
            "a/../../x",
            "a/..",
            "/etc/passwd",
            "a//b",
            "a/",
            "./a",
            "C:/x",
            "C:x",
            "a\\..\\b",
            "\\\\server\\x",
            "a\0b",
            "a\nb",
            "nul:",
            "a./b",
            "x ",
            &"a/".repeat(2000),
        ] {
            assert_eq!(member_path(name).unwrap_err().kind(), ErrorKind::Integrity, "{name:?}");
        }
    }
}
