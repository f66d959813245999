//! `cargo xtask release VERSION`: the commit and the tag of a release. Nothing is pushed or published.

use std::fs;

use crate::inputs;
use crate::shell::{Result, command, output, root, step};
use crate::source_date::SourceDate;

const CURRENT: &str = env!("CARGO_PKG_VERSION");

/// Files with the version, and the text around it.
const PLACES: [(&str, &str, &str); 5] = [
    ("Cargo.toml", "version = \"", "\""),
    ("bindings/models/pyproject.toml", "version = \"", "\""),
    ("ros/opendr/package.xml", "<version>", "</version>"),
    ("ros/opendr_msgs/package.xml", "<version>", "</version>"),
    ("ros/opendr_ros1/package.xml", "<version>", "</version>"),
];

/// Writes the version into all files that have it and into the changelog, commits that, and tags it.
pub fn run(version: &str) -> Result<()> {
    check_follows(version)?;
    let changed = output(command("git").args(["status", "--porcelain"]))?;
    if !changed.is_empty() {
        return Err(format!("commit or undo these changes first:\n{changed}"));
    }
    let tag = format!("v{version}");
    if !output(command("git").args(["tag", "--list", &tag]))?.is_empty() {
        return Err(format!("the tag {tag} exists already"));
    }
    let changelog = released(&inputs::text("CHANGELOG.md")?, version, &SourceDate::now()?.day())?;
    for (file, before, after) in PLACES {
        let (old, new) = (format!("{before}{CURRENT}{after}"), format!("{before}{version}{after}"));
        write(
            file,
            &replaced(&inputs::text(file)?, &old, &new).ok_or_else(|| format!("{file}: {old} is missing"))?,
        )?;
    }
    write("CHANGELOG.md", &changelog)?;
    for manifest in ["Cargo.toml", "fuzz/Cargo.toml"] {
        let mut update = command("cargo");
        step("lock file", update.args(["update", "--workspace", "--offline", "--manifest-path", manifest]))?;
    }
    step("commit", command("git").args(["commit", "--all", "--message", &format!("Release {version}")]))?;
    let message = format!("OpenDR {version}");
    step("tag", command("git").args(["tag", "--annotate", &tag, "--message", &message]))?;
    println!(
        "\n{tag} is ready; push it with \"git push origin HEAD {tag}\", which starts the workflow of the release"
    );
    Ok(())
}

/// Fails if `version` is not a number like 1.2.3 that follows the current one by semantic versioning: one part is incremented, the
/// parts after it are 0.
fn check_follows(version: &str) -> Result<()> {
    let parts = |text: &str| -> Option<[u64; 3]> {
        let parts: Vec<u64> = text.split('.').map(str::parse).collect::<Result<_, _>>().ok()?;
        parts.try_into().ok()
    };
    let current = parts(CURRENT).ok_or_else(|| format!("the current version {CURRENT} is no version"))?;
    let next = parts(version).ok_or_else(|| format!("{version} is no version like 1.2.3"))?;
    let following =
        [[current[0], current[1], current[2] + 1], [current[0], current[1] + 1, 0], [current[0] + 1, 0, 0]];
    // The first release has the version that the manifests have had until then.
    let is_first = next == current && output(command("git").args(["tag", "--list", "v*"]))?.is_empty();
    if is_first || following.contains(&next) {
        return Ok(());
    }
    let following: Vec<_> = following.iter().map(|[a, b, c]| format!("{a}.{b}.{c}")).collect();
    Err(format!("{version} does not follow {CURRENT}; choose one of {}", following.join(", ")))
}

/// Returns the changelog with the entries of `Unreleased` below the version and its date.
fn released(changelog: &str, version: &str, day: &str) -> Result<String> {
    let (before, rest) =
        changelog.split_once("## Unreleased\n").ok_or("CHANGELOG.md has no section Unreleased")?;
    let entries = rest.split("\n## ").next().unwrap_or_default();
    if !entries.lines().any(|line| line.starts_with("- ")) {
        return Err(
            "CHANGELOG.md has no entries below Unreleased; a release without changes is none".to_owned()
        );
    }
    Ok(format!("{before}## Unreleased\n\n## {version} - {day}\n{rest}"))
}

/// Returns a text with `new` instead of `old` in the lines of the version: its own, and those of the crates of the workspace, which have a
/// path. `None` if there is none.
fn replaced(text: &str, old: &str, new: &str) -> Option<String> {
    let is_ours = |line: &str| line.trim_start().starts_with(old) || line.contains("path = ");
    let lines = text.split_inclusive('\n');
    let done: String =
        lines.map(|line| if is_ours(line) { line.replace(old, new) } else { line.to_owned() }).collect();
    (done != text || old == new).then_some(done)
}

fn write(file: &str, text: &str) -> Result<()> {
    fs::write(root().join(file), text).map_err(|error| format!("{file}: {error}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_files_have_the_current_version() {
        for (file, before, after) in PLACES {
            let text = inputs::text(file).unwrap();
            let old = format!("{before}{CURRENT}{after}");
            assert!(replaced(&text, &old, "").is_some(), "{file}: {old}");
        }
        let python = inputs::text("bindings/python/pyproject.toml").unwrap();
        assert!(python.contains("dynamic = [\"version\"]"), "the wheel has the version of Cargo.toml");
    }

    #[test]
    fn versions_of_others_stay() {
        let text = "version = \"0.1.0\"\nours = { path = \"x\", version = \"0.1.0\" }\nother = { version = \"0.1.0\" }\n";
        let new = text.replacen("0.1.0", "0.2.0", 2);
        assert_eq!(replaced(text, "version = \"0.1.0\"", "version = \"0.2.0\"").unwrap(), new);
    }

    #[test]
    fn versions_follow_each_other() {
        for version in ["0.1.1", "0.2.0", "1.0.0"] {
            check_follows(version).unwrap();
        }
        for version in ["0.0.9", "0.3.0", "0.2.1", "2.0.0", "0.2", "v0.2.0", "0.2.0-rc.1", ""] {
            assert!(check_follows(version).is_err(), "{version}");
        }
    }

    #[test]
    fn entries_move_below_the_version() {
        let changelog =
            "# Changelog\n\n## Unreleased\n\n### Added\n\n- A.\n\n## 0.1.0 - 2026-01-01\n\n- B.\n";
        let text = released(changelog, "0.2.0", "2026-11-29").unwrap();
        assert!(
            text.contains("## Unreleased\n\n## 0.2.0 - 2026-11-29\n\n### Added\n\n- A.\n\n## 0.1.0"),
            "{text}"
        );
        assert!(
            released("# Changelog\n\n## Unreleased\n\n## 0.1.0\n\n- B.\n", "0.2.0", "2026-11-29").is_err()
        );
    }
}
