//! Gets ONNX Runtime's library into the cache, out of its Python package.

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

/// The Python that the wheel is for when the registry has none for the installed one; the library is the same in all.
const OTHER_PYTHON: &str = "3.12";

/// Bytes of the largest library that is taken out of a wheel; that of 1.31 has 24 MB.
const MAX_SIZE: u64 = 512 << 20;

/// Loads the library and prints its version: `OrtGetApiBase()->GetVersionString()`.
const PRINT_VERSION: &str = "\
import ctypes, sys
base = ctypes.CDLL(sys.argv[1]).OrtGetApiBase
base.restype = ctypes.POINTER(ctypes.c_void_p)
print(ctypes.CFUNCTYPE(ctypes.c_char_p)(base()[1])().decode())
";

/// What [`install_onnx_runtime`] came to; its text says so to people.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct InstalledRuntime {
    /// Where the library is.
    pub path: PathBuf,
    /// ONNX Runtime's version.
    pub version: String,
    /// Bytes of the library.
    pub size: u64,
    /// Whether it was there before.
    pub was_there: bool,
}

impl fmt::Display for InstalledRuntime {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let did = if self.was_there { "is there already" } else { "got with pip and checked that it loads" };
        let megabytes = self.size as f64 / 1e6;
        write!(f, "ONNX Runtime {}, {did}: {} ({megabytes:.1} MB)", self.version, self.path.display())
    }
}

/// Gets ONNX Runtime's library into the cache, where this and later processes find it; installs nothing elsewhere.
///
/// Of several processes that do so at once one works and the others wait for it. One that is killed leaves nothing
/// that counts.
///
/// # Errors
/// `Unsupported` when Python has no pip, `NotFound` when the registry has no package for this machine, `Network` when
/// it cannot be reached or `options` say offline, `Integrity` when the library does not load.
pub fn install_onnx_runtime(options: &ZooOptions, progress: &dyn Progress) -> Result<InstalledRuntime> {
    let folder = OnnxRuntime::cache_folder(&options.cache);
    let _turn = Lock::acquire(&options.cache.join("locks/onnxruntime.lock"), "ONNX Runtime", progress)?;
    if let Some(installed) = there_already(&folder) {
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
        return Err(Error::unsupported(format!(
            "pip brought ONNX Runtime {version}, which is too old to use"
        )));
    }
    let path = folder.join(library.file_name().unwrap_or_default());
    fs::create_dir_all(&folder).context(|| folder.display().to_string())?;
    fs::rename(&library, &path).context(|| path.display().to_string())?;
    OnnxRuntime::search_again();
    Ok(InstalledRuntime { size: fs::metadata(&path)?.len(), path, version, was_there: false })
}

/// Only libraries that were checked get to the cache.
fn there_already(folder: &Path) -> Option<InstalledRuntime> {
    let path = OnnxRuntime::libraries_in(folder).into_iter().next()?;
    let version = version_of(&path).ok().filter(|version| OnnxRuntime::is_supported(version))?;
    let size = fs::metadata(&path).ok()?.len();
    Some(InstalledRuntime { path, version, size, was_there: true })
}

fn wheel(python: Option<&str>, work: &WorkFolder, progress: &dyn Progress) -> Result<PathBuf> {
    let requirement = format!("onnxruntime>={}", OnnxRuntime::OLDEST);
    pip::download(&Wheel { requirement: &requirement, size: None, python, platform: None }, work, progress)
}

/// Unpacks the library alone, under its own name, into `folder`.
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
            return Err(Error::integrity(format!("the member {name:?} is no file of a fitting size")));
        }
        let (path, size) = (folder.join(name), entry.size());
        let mut file = File::create(&path)?;
        let written = io::copy(&mut entry.take(size + 1), &mut file).map_err(damaged)?;
        if written != size {
            return Err(Error::integrity(format!(
                "the member {name:?} has not the {size} bytes that it states"
            )));
        }
        file.sync_all()?;
        return Ok(path);
    }
    Err(Error::integrity("no library of ONNX Runtime in it"))
}

/// Asks the library in a process of its own: this one may have another loaded, and a broken one must not take it along.
fn version_of(library: &Path) -> Result<String> {
    let output = Command::new(pip::python_with_pip()?)
        .args(["-c", PRINT_VERSION])
        .arg(library)
        .stdin(Stdio::null())
        .output()
        .context(|| "asking ONNX Runtime for its version")?;
    let words = |bytes: &[u8]| String::from_utf8_lossy(bytes).trim().to_owned();
    if !output.status.success() {
        let words = words(&output.stderr);
        return Err(Error::integrity("the ONNX Runtime that pip brought does not load")
            .with_source(words.lines().last().unwrap_or("without a word").to_owned()));
    }
    Ok(words(&output.stdout))
}
