//! Installation of ONNX Runtime, with a simulated Python.

use std::io::{Cursor, Write as _};
use std::os::unix::fs::PermissionsExt as _;
use std::path::Path;
use std::process::{Child, Command, Output, Stdio};
use std::{env, fs};

use crate::place::Place;
use opendr_engine::Silent;
use opendr_zoo::{ZooOptions, install_onnx_runtime};
use zip::ZipWriter;
use zip::write::SimpleFileOptions;

const CACHE: &str = "OPENDR_RUNTIME_TEST_CACHE";

/// Answers as `python3 -m pip` and as the version check do. `$1 $2 $3` tell which; the wheel lies beside it.
const PYTHON: &str = r#"#!/bin/sh
PATH=/usr/bin:/bin
here=$(dirname "$0")
case "$*" in
  "-m pip --version") exit 0 ;;
  "-m pip download"*)
    echo call >> "$here/calls"
    if [ -f "$here/error" ]; then cat "$here/error" >&2; exit 1; fi
    while [ "$1" != "--dest" ]; do shift; done
    sleep 0.3
    cp "$here/onnxruntime.whl" "$2/" ;;
  "-c "*) if [ -f "$here/broken" ]; then echo "OSError: invalid ELF header" >&2; exit 1; fi; cat "$here/version" ;;
esac
"#;

/// Not a test: what the child processes of the tests do.
#[test]
fn child() {
    let Some(cache) = env::var_os(CACHE) else { return };
    match install_onnx_runtime(&ZooOptions::new(cache), &Silent) {
        Ok(installed) => println!("installed={installed}"),
        Err(error) => println!("error={error:?}"),
    }
}

fn zip(members: &[(&str, &[u8])]) -> Vec<u8> {
    let mut writer = ZipWriter::new(Cursor::new(Vec::new()));
    for (name, bytes) in members {
        writer.start_file(*name, SimpleFileOptions::default()).unwrap();
        writer.write_all(bytes).unwrap();
    }
    writer.finish().unwrap().into_inner()
}

/// A folder with the Python, its wheel with these members, and the version of the library in it.
fn python(place: &Place, members: &[(&str, &[u8])], version: &str) {
    let bin = place.0.join("bin");
    fs::create_dir_all(&bin).unwrap();
    fs::write(bin.join("python3"), PYTHON).unwrap();
    fs::set_permissions(bin.join("python3"), fs::Permissions::from_mode(0o755)).unwrap();
    fs::write(bin.join("onnxruntime.whl"), zip(members)).unwrap();
    fs::write(bin.join("version"), version).unwrap();
}

fn spawn(place: &Place) -> Child {
    Command::new(env::current_exe().unwrap())
        .args(["--exact", "onnx_runtime::child", "--nocapture"])
        .env(CACHE, place.0.join("cache"))
        .env("PATH", place.0.join("bin"))
        .stdout(Stdio::piped())
        .spawn()
        .unwrap()
}

fn said(output: &Output) -> String {
    let text = String::from_utf8_lossy(&output.stdout);
    text.lines()
        .find_map(|line| Some(line[line.find("installed=").or(line.find("error="))?..].to_owned()))
        .unwrap()
}

fn install(place: &Place) -> String {
    said(&spawn(place).wait_with_output().unwrap())
}

fn names(folder: &Path) -> Vec<String> {
    let Ok(entries) = fs::read_dir(folder) else { return Vec::new() };
    entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect()
}

#[test]
fn only_the_library_of_the_wheel_gets_to_the_cache() {
    let place = Place::new();
    let members: [(&str, &[u8]); 4] = [
        ("onnxruntime/__init__.py", b"print()"),
        ("onnxruntime/capi/libonnxruntime_providers_shared.so", b"providers"),
        ("onnxruntime/capi/libonnxruntime.so.1.31.1", b"library"),
        ("../../libonnxruntime.so.9.9.9", b"evil"),
    ];
    python(&place, &members, "1.31.1");
    let text = install(&place);
    assert!(text.contains("ONNX Runtime 1.31.1, downloaded with pip"), "{text}");
    let folder = place.0.join("cache/onnxruntime");
    assert_eq!(names(&folder), ["libonnxruntime.so.1.31.1"]);
    assert_eq!(fs::read(folder.join("libonnxruntime.so.1.31.1")).unwrap(), b"library");
    let text = install(&place);
    assert!(text.contains("already in the cache"), "{text}");
    assert_eq!(fs::read_to_string(place.0.join("bin/calls")).unwrap(), "call\n");
}

#[test]
fn two_processes_at_once_call_pip_once() {
    let place = Place::new();
    python(&place, &[("onnxruntime/capi/libonnxruntime.so.1.31.1", b"library")], "1.31.1");
    let children: Vec<_> = (0..3).map(|_| spawn(&place)).collect();
    for child in children {
        let text = said(&child.wait_with_output().unwrap());
        assert!(text.contains("ONNX Runtime 1.31.1"), "{text}");
    }
    assert_eq!(fs::read_to_string(place.0.join("bin/calls")).unwrap(), "call\n");
}

#[test]
fn failed_installations_are_reported_and_not_kept() {
    let library: [(&str, &[u8]); 1] = [("onnxruntime/capi/libonnxruntime.so.1.31.1", b"library")];
    let place = Place::new();
    python(&place, &[("onnxruntime/capi/onnxruntime.txt", b"text")], "1.31.1");
    assert!(install(&place).contains("Integrity: "), "no library in the wheel");

    python(&place, &library, "1.19.2");
    let text = install(&place);
    assert!(text.contains("Unsupported: pip downloaded ONNX Runtime 1.19.2, which is too old"), "{text}");

    fs::write(place.0.join("bin/broken"), "").unwrap();
    let text = install(&place);
    assert!(
        text.contains("Integrity: the ONNX Runtime that pip downloaded does not load (OSError"),
        "{text}"
    );

    fs::write(place.0.join("bin/error"), "NewConnectionError: no route to host").unwrap();
    let text = install(&place);
    assert!(text.contains("Network: python3 failed: NewConnectionError"), "{text}");

    fs::write(place.0.join("bin/error"), "ERROR: No matching distribution found for onnxruntime>=1.23")
        .unwrap();
    let before = fs::read_to_string(place.0.join("bin/calls")).unwrap().lines().count();
    let text = install(&place);
    assert!(text.contains("NotFound: python3 failed: ERROR: No matching distribution"), "{text}");
    let after = fs::read_to_string(place.0.join("bin/calls")).unwrap().lines().count();
    assert_eq!(after - before, 2, "asks for another Python's wheel too");

    fs::remove_file(place.0.join("bin/python3")).unwrap();
    let text = install(&place);
    assert!(text.contains("Unsupported: neither python3 nor python has pip"), "{text}");
    assert!(names(&place.0.join("cache/onnxruntime")).is_empty());
}
