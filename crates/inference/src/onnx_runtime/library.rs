//! Search and loading of the ONNX Runtime library, once per process.

use std::env::{self, consts};
use std::fmt;
use std::fs;
use std::path::{Path, PathBuf};

use opendr_engine::{Error, Result, cache_dir};
use ort::environment::Environment;
use ort::logging::LogLevel;

use super::message::message_of;
use super::python;

/// Oldest supported version.
pub(super) const MIN_VERSION: &str = "1.23";

/// Returns the folder within a cache folder that is searched for the library.
pub(super) fn cache_folder(cache: &Path) -> PathBuf {
    cache.join("onnxruntime")
}

/// A version of ONNX Runtime.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Version([u32; 3]);

impl Version {
    /// Parses `1.31.1`, `libonnxruntime.so.1.31.1`, `libonnxruntime.1.31.1.dylib`; `None` without a version.
    pub(super) fn parse(text: &str) -> Option<Self> {
        let mut numbers = text.split('.').filter_map(|part| part.parse().ok());
        Some(Self([numbers.next()?, numbers.next()?, numbers.next()?]))
    }

    pub(super) fn is_supported(self) -> bool {
        self >= Self([1, 23, 0])
    }
}

impl fmt::Display for Version {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [major, minor, patch] = self.0;
        write!(f, "{major}.{minor}.{patch}")
    }
}

/// The loaded library.
pub(super) struct Library {
    pub(super) path: PathBuf,
    /// `None` when the file name does not state it: 1.23 or later.
    pub(super) version: Option<Version>,
    pub(super) environment: Environment,
}

/// Loads the first working library of the search order. Skipped libraries are added to `skipped` with the reason.
pub(super) fn find(skipped: &mut Vec<String>) -> Option<Library> {
    let mut files = Vec::new();
    if let Some(path) = env::var_os("ORT_DYLIB_PATH").filter(|path| !path.is_empty()) {
        let path = PathBuf::from(path);
        files.extend(if path.is_dir() { libraries_in(&path) } else { vec![path] });
    }
    files.extend(python::onnxruntime_folders().iter().flat_map(|folder| libraries_in(folder)));
    files.extend(
        cache_dir().ok().map(|cache| cache_folder(&cache)).iter().flat_map(|folder| libraries_in(folder)),
    );
    for file in files {
        match load(&file) {
            Ok(library) => return Some(library),
            Err(error) => skipped.push(error.to_string()),
        }
    }
    load_from_system(skipped)
}

/// Returns the ONNX Runtime libraries in a folder, newest first.
pub(super) fn libraries_in(folder: &Path) -> Vec<PathBuf> {
    let Ok(entries) = fs::read_dir(folder) else { return Vec::new() };
    let mut found: Vec<_> = entries
        .flatten()
        .filter_map(|entry| {
            let name = entry.file_name().into_string().ok()?;
            is_library(&name).then(|| (Version::parse(&name), entry.path()))
        })
        .collect();
    found.sort();
    found.into_iter().rev().map(|(_, path)| path).collect()
}

/// Returns whether `name` is that of the library, such as `libonnxruntime.so`, `libonnxruntime.so.1.31.1`,
/// `libonnxruntime.1.31.1.dylib`, `onnxruntime.dll`; not one of its providers.
pub(super) fn is_library(name: &str) -> bool {
    let Some(rest) = name.strip_prefix(consts::DLL_PREFIX).and_then(|name| name.strip_prefix("onnxruntime"))
    else {
        return false;
    };
    rest.starts_with('.')
        && rest.split('.').skip(1).all(|part| {
            part == consts::DLL_EXTENSION
                || (!part.is_empty() && part.bytes().all(|byte| byte.is_ascii_digit()))
        })
        && rest.contains(consts::DLL_SUFFIX)
}

/// Loads the library at `path`.
pub(super) fn load(path: &Path) -> Result<Library> {
    // ort resolves a relative path against the folder of the executable.
    let path = path.canonicalize().map_err(|error| {
        Error::not_found(format!("there is no ONNX Runtime library at {}", path.display())).with_source(error)
    })?;
    let version = path.file_name().and_then(|name| Version::parse(&name.to_string_lossy()));
    if let Some(version) = version.filter(|version| !version.is_supported()) {
        return Err(too_old(&version.to_string(), &path));
    }
    let environment = start(&path)?;
    Ok(Library { path, version, environment })
}

/// Loads the library by name through the system's loader.
fn load_from_system(skipped: &mut Vec<String>) -> Option<Library> {
    // ort first searches the folder of the executable, and panics when that is unknown.
    env::current_exe().ok()?;
    let path = PathBuf::from(format!("{}onnxruntime{}", consts::DLL_PREFIX, consts::DLL_SUFFIX));
    match start(&path) {
        Ok(environment) => Some(Library { path, version: None, environment }),
        // A missing library is the usual case and is not reported.
        Err(error) if error.kind() == opendr_engine::ErrorKind::Format => None,
        Err(error) => {
            skipped.push(error.to_string());
            None
        }
    }
}

fn start(path: &Path) -> Result<Environment> {
    let builder = ort::init_from(path).map_err(|error| match error {
        ort::LoadDynamicError::BadVersion { version_str, path } => too_old(&version_str, &path),
        other => {
            Error::format(format!("{} is not an ONNX Runtime library", path.display())).with_source(other)
        }
    })?;
    let environment = builder.with_name("opendr").with_telemetry(false).build().map_err(|error| {
        Error::internal(format!("ONNX Runtime at {} failed to start", path.display()))
            .with_source(message_of(&error))
    })?;
    // Messages on standard error are also returned as errors.
    if env::var_os("ORT_LOG").is_none() {
        environment.set_log_level(LogLevel::Fatal);
    }
    Ok(environment)
}

fn too_old(version: &str, path: &Path) -> Error {
    Error::unsupported(format!(
        "ONNX Runtime {version} at {} is older than {}; update it or run \"opendr runtime install\"",
        path.display(),
        MIN_VERSION
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    #[cfg(target_os = "linux")]
    fn distinguishes_the_library_from_its_providers() {
        for name in ["libonnxruntime.so", "libonnxruntime.so.1", "libonnxruntime.so.1.31.1"] {
            assert!(is_library(name), "{name}");
        }
        for name in [
            "libonnxruntime_providers_shared.so",
            "libonnxruntime.so.txt",
            "libonnxruntime.so.1.31.1.part",
            "onnxruntime.so",
            "libonnxruntime",
            "libonnxruntime.1",
        ] {
            assert!(!is_library(name), "{name}");
        }
    }

    #[test]
    fn version_comes_from_the_name() {
        let version = |name| Version::parse(name);
        assert_eq!(version("libonnxruntime.so.1.31.1"), Some(Version([1, 31, 1])));
        assert_eq!(version("libonnxruntime.1.23.0.dylib"), Some(Version([1, 23, 0])));
        assert_eq!(version("libonnxruntime.so"), None);
        assert!(version("libonnxruntime.so.1.23.0").is_some_and(Version::is_supported));
        assert!(!version("libonnxruntime.so.1.19.2").is_some_and(Version::is_supported));
    }
}
