//! The generated sources in the repository are up to date.
#![allow(clippy::unwrap_used)]

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use opendr_message_generator::{Library, Ros1Names, TypeName, rust_files};

fn names(text: &str) -> Ros1Names {
    let name = |text: &str| {
        let (package, name) = text.split_once('/').unwrap();
        TypeName::new(package, name)
    };
    text.lines()
        .filter(|line| !line.starts_with('#'))
        .map(|line| {
            let (ros2, ros1) = line.split_once(' ').unwrap();
            (name(ros2), (ros1 != "-").then(|| name(ros1)))
        })
        .collect()
}

/// Read at run time, since a build folder shared by several clones may contain programs of another clone.
fn crate_folder() -> PathBuf {
    PathBuf::from(std::env::var_os("CARGO_MANIFEST_DIR").unwrap())
}

fn formatted(files: BTreeMap<String, String>, folder: &Path) -> BTreeMap<String, String> {
    for (path, text) in &files {
        let path = folder.join(path);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, text).unwrap();
    }
    let rustfmt = Command::new("rustfmt")
        .args(["--edition", "2024", "--config-path"])
        .arg(crate_folder().join("../../rustfmt.toml"))
        .args(
            files
                .keys()
                .filter(|path| *path != "mod.rs" && *path != "ros1/mod.rs")
                .map(|path| folder.join(path)),
        )
        .stdin(Stdio::null())
        .status()
        .unwrap();
    assert!(rustfmt.success());
    files.keys().map(|path| (path.clone(), fs::read_to_string(folder.join(path)).unwrap())).collect()
}

#[test]
fn generated_sources_are_up_to_date() {
    let root = crate_folder().join("../messages");
    let ros2 = Library::open(&root.join("msg")).unwrap();
    let ros1 = ros2.with_overrides(&root.join("ros1")).unwrap();
    let names = names(&fs::read_to_string(root.join("ros1/names.txt")).unwrap());
    let made = rust_files(&ros2, &ros1, &names).unwrap();
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("messages");
    let _ = fs::remove_dir_all(&folder);
    let made = formatted(made, &folder);
    let sources = root.join("src/generated");
    if std::env::var_os("OPENDR_UPDATE").is_some() {
        let _ = fs::remove_dir_all(&sources);
        for (path, text) in &made {
            let path = sources.join(path);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(path, text).unwrap();
        }
        return;
    }
    for (path, text) in &made {
        let there = fs::read_to_string(sources.join(path)).unwrap_or_default();
        assert!(there == *text, "{path} is not what the definitions make; run `cargo xtask generate`");
    }
}
