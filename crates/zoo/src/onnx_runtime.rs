//! Installation of ONNX Runtime's library into the cache, from its Python package.

use std::fmt;
use std::fs::{self, File};
use std::io::{self, BufReader, Read};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use opendr_engine::{Error, ErrorKind, Progress, Result, ResultExt};
use opendr_inference::OnnxRuntime;
use zip::ZipArchive;

use crate::ZooOptions;
use crate::lock::Lock;
use crate::pip::{self, Wheel};
use crate::work_folder::WorkFolder;

/// Python version of the wheel when the registry has none for the installed version; the library is the same in all wheels.
const OTHER_PYTHON: &str = "3.12";

/// Maximum size of the library in a wheel, in bytes; that of 1.31 has 24 MB.
const MAX_SIZE: u64 = 512 << 20;

/// Loads the library and prints its version: `OrtGetApiBase()->GetVersionString()`.
const PRINT_VERSION: &str = "\
import ctypes, sys
base = ctypes.CDLL(sys.argv[1]).OrtGetApiBase
base.restype = ctypes.POINTER(ctypes.c_void_p)
print(ctypes.CFUNCTYPE(ctypes.c_char_p)(base()[1])().decode())
";

/// Result of [`install_onnx_runtime`]. `Display` prints one line.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct InstalledRuntime {
    /// Path of the library.
    pub path: PathBuf,
    /// Version of ONNX Runtime.
    pub version: String,
    /// Size of the library in bytes.
    pub size: u64,
    /// Whether the library was already in the cache.
    pub was_cached: bool,
}

impl fmt::Display for InstalledRuntime {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let did = if self.was_cached {
            "already in the cache"
        } else {
            "downloaded with pip and loaded as a check"
        };
        let megabytes = self.size as f64 / 1e6;
        write!(f, "ONNX Runtime {}, {did}: {} ({megabytes:.1} MB)", self.version, self.path.display())
    }
}

/// Installs ONNX Runtime's library into the cache, where this and later processes use it; writes nothing elsewhere.
///
/// Of several processes at once, one downloads and the others wait. A killed process leaves no incomplete library.
///
/// # Errors
/// `Unsupported` when Python has no pip, `NotFound` when the registry has no package for this machine, `Network` when
/// it cannot be reached or `options` say offline, `Integrity` when the library does not load.
pub fn install_onnx_runtime(options: &ZooOptions, progress: &dyn Progress) -> Result<InstalledRuntime> {
    let folder = OnnxRuntime::cache_folder(&options.cache);
    let _turn = Lock::acquire(&options.cache.join("locks/onnxruntime.lock"), "ONNX Runtime", progress)?;
    if let Some(installed) = cached(&folder) {
        return Ok(installed);
    }
    if options.offline {
        return Err(Error::network("OPENDR_OFFLINE is set, and ONNX Runtime is not in the cache"));
    }
    let work = WorkFolder::new(&options.cache.join("work"), progress)?;
    let wheel = wheel(None, &work, progress).or_else(|error| match error.kind() {
        ErrorKind::NotFound => wheel(Some(OTHER_PYTHON), &work, progress).map_err(|_| error),
        _ => Err(error),
    })?;
    let library = library_from_wheel(&wheel, work.path()).context(|| wheel.display().to_string())?;
    let version = version_of(&library)?;
    if !OnnxRuntime::is_supported(&version) {
        return Err(Error::unsupported(format!("pip downloaded ONNX Runtime {version}, which is too old")));
    }
    let path = folder.join(library.file_name().unwrap_or_default());
    fs::create_dir_all(&folder).context(|| folder.display().to_string())?;
    fs::rename(&library, &path).context(|| path.display().to_string())?;
    OnnxRuntime::reset_search();
    Ok(InstalledRuntime { size: fs::metadata(&path)?.len(), path, version, was_cached: false })
}

/// Returns the library in the cache, which holds checked libraries only.
fn cached(folder: &Path) -> Option<InstalledRuntime> {
    let path = OnnxRuntime::libraries_in(folder).into_iter().next()?;
    let version = version_of(&path).ok().filter(|version| OnnxRuntime::is_supported(version))?;
    let size = fs::metadata(&path).ok()?.len();
    Some(InstalledRuntime { path, version, size, was_cached: true })
}

fn wheel(python: Option<&str>, work: &WorkFolder, progress: &dyn Progress) -> Result<PathBuf> {
    let requirement = format!("onnxruntime>={}", OnnxRuntime::MIN_VERSION);
    pip::download(&Wheel { requirement: &requirement, size: None, python, platform: None }, work, progress)
}

/// Extracts only the library, under its own name, into `folder`.
fn library_from_wheel(wheel: &Path, folder: &Path) -> Result<PathBuf> {
    let damaged = |error: io::Error| Error::integrity("the archive is damaged").with_source(error);
    let mut archive =
        ZipArchive::new(BufReader::new(File::open(wheel)?)).map_err(|error| damaged(error.into()))?;
    for index in 0..archive.len() {
        let entry = archive.by_index(index).map_err(|error| damaged(error.into()))?;
        let name = entry.name().map_err(|error| damaged(error.into()))?.into_owned();
        let Some(name) = name.strip_prefix("onnxruntime/capi/").filter(|name| OnnxRuntime::is_library(name))
        else {
            continue;
        };
        if !entry.is_file() || entry.size() > MAX_SIZE {
            return Err(Error::integrity(format!("the member {name:?} is not a file of an allowed size")));
        }
        let (path, size) = (folder.join(name), entry.size());
        let mut file = File::create(&path)?;
        let written = io::copy(&mut entry.take(size + 1), &mut file).map_err(damaged)?;
        if written != size {
            return Err(Error::integrity(format!(
                "the member {name:?} does not have its stated size of {size} bytes"
            )));
        }
        file.sync_all()?;
        return Ok(path);
    }
    Err(Error::integrity("the wheel contains no library of ONNX Runtime"))
}

/// Returns the version of the library, from a process of its own: this process may have another version loaded, and a broken
/// library must not crash it.
fn version_of(library: &Path) -> Result<String> {
    let output = Command::new(pip::python_with_pip()?)
        .args(["-c", PRINT_VERSION])
        .arg(library)
        .stdin(Stdio::null())
        .output()
        .context(|| "reading the version of ONNX Runtime")?;
    let words = |bytes: &[u8]| String::from_utf8_lossy(bytes).trim().to_owned();
    if !output.status.success() {
        let words = words(&output.stderr);
        return Err(Error::integrity("the ONNX Runtime that pip downloaded does not load")
            .with_source(words.lines().last().unwrap_or("no output").to_owned()));
    }
    Ok(words(&output.stdout))
}
