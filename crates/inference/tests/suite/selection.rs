//! Selection of the runtime, and the messages when it is not the best one. Each case runs in a process of its own,
//! because the search runs once per process.

use std::env;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::test_data::test_data;
use opendr_engine::{Device, ErrorKind};
use opendr_inference::{OnnxRuntime, Session, describe, runtimes};

const DEVICE: &str = "OPENDR_SELECTION_TEST";

/// Entry point of the processes that the tests start.
#[test]
fn child() {
    let Ok(device) = env::var(DEVICE) else { return };
    match describe(device.parse::<Device>().unwrap()) {
        Ok(line) => println!("said={line}"),
        Err(error) => println!("said={error:?}"),
    }
}

/// A temporary folder, removed on drop.
struct Place(PathBuf);

impl Place {
    fn new(name: &str) -> Self {
        let path = env::temp_dir().join(format!("opendr-selection-{name}-{}", std::process::id()));
        fs::create_dir_all(&path).unwrap();
        Self(path.canonicalize().unwrap())
    }

    fn write(&self, name: &str, bytes: &[u8]) -> PathBuf {
        let path = self.0.join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(&path, bytes).unwrap();
        path
    }

    /// Returns the description of the runtime for `device` in a process with only these variables.
    fn said(&self, device: &str, variables: &[(&str, &Path)]) -> String {
        let mut command = Command::new(env::current_exe().unwrap());
        command
            .args(["--exact", "selection::child", "--nocapture"])
            .env_clear()
            .env("HOME", self.0.join("home"));
        command.env("OPENDR_CACHE", self.0.join("cache")).env(DEVICE, device).envs(variables.iter().copied());
        let output = command.output().unwrap();
        let text = String::from_utf8(output.stdout).unwrap();
        assert!(output.status.success(), "{text}{}", String::from_utf8_lossy(&output.stderr));
        text.lines().find_map(|line| Some(line[line.find("said=")? + 5..].to_owned())).unwrap()
    }
}

/// Returns whether the system's loader finds a library, which makes these tests impossible.
fn system_has_one(place: &Place) -> bool {
    let has = place.said("auto", &[]).starts_with("ONNX Runtime");
    if has {
        eprintln!("skipped: the system has an ONNX Runtime");
    }
    has
}

impl Drop for Place {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

fn library_name(version: &str) -> String {
    if cfg!(windows) {
        "onnxruntime.dll".into()
    } else if cfg!(target_os = "macos") {
        format!("libonnxruntime.{version}.dylib")
    } else {
        format!("libonnxruntime.so.{version}")
    }
}

#[test]
fn no_library_means_the_built_in_runtime_and_a_hint() {
    let place = Place::new("none");
    if system_has_one(&place) {
        return;
    }
    let line = place.said("auto", &[]);
    assert!(line.starts_with("built-in (graph executor, ") && line.contains("), cpu, "), "{line}");
    assert!(line.contains(" times as long as ONNX Runtime"), "{line}");
    assert!(line.contains("\"opendr runtime install\" installs"), "{line}");
    let line = place.said("auto", &[("OPENDR_RUNTIME", Path::new("builtin"))]);
    assert!(line.starts_with("built-in") && !line.contains("install"), "{line}");
}

#[test]
fn invalid_environment_variables_are_errors() {
    let place = Place::new("wishes");
    if system_has_one(&place) {
        return;
    }
    for (variable, value, says) in [
        (
            "OPENDR_RUNTIME",
            "tract",
            "InvalidParam: environment variable OPENDR_RUNTIME is \"tract\"; set it to one of auto",
        ),
        ("OPENDR_RUNTIME", "onnxruntime", "NotFound: no ONNX Runtime found; run \"opendr runtime install\""),
        ("OPENDR_THREADS", "many", "InvalidParam: environment variable OPENDR_THREADS is \"many\""),
        ("OPENDR_DEVICE", "gpu", "InvalidParam: environment variable OPENDR_DEVICE: no device \"gpu\""),
        (
            "OPENDR_DEVICE",
            "cuda:1",
            "Device: device cuda:1 needs ONNX Runtime; the built-in runtime supports: cpu",
        ),
    ] {
        let line = place.said("auto", &[(variable, Path::new(value))]);
        assert!(line.starts_with(says), "{line}");
    }
    let line = place.said("cpu", &[("OPENDR_THREADS", Path::new("1"))]);
    assert!(line.contains("cpu, 1 thread;"), "{line}");
}

#[test]
fn files_that_are_not_a_library_are_skipped() {
    let place = Place::new("text");
    if system_has_one(&place) {
        return;
    }
    let text = place.write("libonnxruntime.so", b"not a library");
    let line = place.said("auto", &[("ORT_DYLIB_PATH", &text)]);
    assert!(line.starts_with("built-in"), "{line}");
    let says = format!("skipped: {} is not an ONNX Runtime library", text.display());
    assert!(line.contains(&says), "{line}");
    let line = place.said("auto", &[("ORT_DYLIB_PATH", &text), ("OPENDR_RUNTIME", Path::new("onnxruntime"))]);
    assert!(line.starts_with("NotFound: ") && line.contains("is not an ONNX Runtime library"), "{line}");
    let line = place.said("auto", &[("ORT_DYLIB_PATH", &place.0.join("absent.so"))]);
    assert!(line.contains("skipped: there is no ONNX Runtime library at"), "{line}");
}

#[cfg(unix)]
#[test]
fn old_library_of_python_is_skipped_with_one_line() {
    let place = Place::new("old");
    if system_has_one(&place) {
        return;
    }
    let package = "venv/lib/python3.9/site-packages/onnxruntime/capi";
    place.write(&format!("{package}/{}", library_name("1.19.2")), b"old");
    let line = place.said("auto", &[("VIRTUAL_ENV", &place.0.join("venv"))]);
    assert!(line.starts_with("built-in"), "{line}");
    assert!(line.contains("skipped: ONNX Runtime 1.19.2 at"), "{line}");
    assert!(line.contains("is older than 1.23; update it or run \"opendr runtime install\""), "{line}");
}

#[cfg(unix)]
#[test]
fn library_is_found_in_python_and_in_the_cache() {
    let onnx_runtime =
        OnnxRuntime::find().expect("set ORT_DYLIB_PATH to the library of ONNX Runtime 1.23 or later");
    let library = onnx_runtime.path();
    let place = Place::new("real");
    let line = place.said("auto", &[("ORT_DYLIB_PATH", library)]);
    assert!(line.starts_with("ONNX Runtime ") && line.contains(library.to_str().unwrap()), "{line}");
    for folder in ["venv/lib/python3.11/site-packages/onnxruntime/capi", "cache/onnxruntime"] {
        let folder = place.0.join(folder);
        fs::create_dir_all(&folder).unwrap();
        std::os::unix::fs::symlink(library, folder.join(library_name("1.23.0"))).unwrap();
    }
    for variables in [&[][..], &[("VIRTUAL_ENV", &*place.0.join("venv"))]] {
        let line = place.said("auto", variables);
        assert!(line.starts_with("ONNX Runtime ") && line.contains(library.to_str().unwrap()), "{line}");
    }
    // A text file in place of Python's library does not hide the one in the cache.
    let text = place.write("libonnxruntime.so", b"not a library");
    let line = place.said("auto", &[("ORT_DYLIB_PATH", &text)]);
    assert!(line.starts_with("ONNX Runtime "), "{line}");
}

#[test]
fn missing_device_is_an_error_that_lists_the_available_ones() {
    let Some(root) = test_data() else { return };
    let model = fs::read(root.join("models/face_detection/yunet_n_320_320.onnx")).unwrap();
    for runtime in runtimes() {
        let devices = runtime.devices();
        assert_eq!(devices.last(), Some(&Device::Cpu), "{}", runtime.name());
        for device in
            [Device::Cuda(0), Device::TensorRt(0), Device::OpenVino, Device::CoreMl, Device::Vulkan(0)]
        {
            if devices.contains(&device) {
                continue;
            }
            let error = Session::open_with(&*runtime, &model, device).unwrap_err();
            assert_eq!(error.kind(), ErrorKind::Device, "{error}");
            assert!(
                error.message().contains(&device.to_string()) && error.message().contains("cpu"),
                "{error}"
            );
        }
        assert_eq!(Session::open_with(&*runtime, &model, Device::Cpu).unwrap().device(), Device::Cpu);
        let auto = Session::open_with(&*runtime, &model, Device::Auto).unwrap();
        assert!(devices.contains(&auto.device()));
    }
}
