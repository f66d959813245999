//! ONNX Runtime, loaded at run time.

mod engine;
mod library;
mod message;
mod provider;
mod python;
mod suited;

pub use python::prefer_python;

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

use opendr_engine::{Device, Error, Result};
use ort::session::Session;
use ort::session::builder::{GraphOptimizationLevel, SessionBuilder};

use crate::onnx_header::OnnxHeader;
use crate::runtime::{Engine, Runtime, SessionOptions};
use crate::tensor::TensorInfo;
use engine::OnnxRuntimeEngine;
use library::{Library, Version};
use message::message_of;
use suited::suited;

/// Time for which idle threads of ONNX Runtime spin before they sleep; versions without this option ignore it.
///
/// The default of some milliseconds slows down a machine with other load, such as a robot. CenterNet, 2 threads on 2
/// cores, milliseconds per run: beside four busy processes 110 to 2000 by default, 70 to 110 with 50 us, 60 to 90
/// without spinning; on idle cores 40 to 51, 32 to 36, 40 to 43.
const SPIN_MICROSECONDS: &str = "50";

/// ONNX Runtime: the fastest runtime on every device, where its library is installed.
///
/// The library is searched for once per process, in this order: `ORT_DYLIB_PATH` (a file or folder), the
/// `onnxruntime` package of the active Python environment or of the `python3` on the search path, the cache that
/// `opendr runtime install` fills, the system's loader.
pub struct OnnxRuntime(Library);

/// Result of the search of this process.
#[derive(Default)]
struct Search {
    found: Option<Arc<OnnxRuntime>>,
    done: bool,
    skipped: Vec<String>,
}

static SEARCH: Mutex<Search> = Mutex::new(Search { found: None, done: false, skipped: Vec::new() });

impl OnnxRuntime {
    /// Returns the ONNX Runtime of this process; the first call searches for its library.
    ///
    /// # Errors
    /// `NotFound` with the skipped libraries and how to install one.
    pub fn find() -> Result<Arc<Self>> {
        let mut search = SEARCH.lock().unwrap_or_else(PoisonError::into_inner);
        if !search.done {
            search.found = library::find(&mut search.skipped).map(|library| Arc::new(Self(library)));
            search.done = true;
        }
        search.found.clone().ok_or_else(|| {
            let mut message = String::from("no ONNX Runtime found; run \"opendr runtime install\"");
            message.extend(search.skipped.iter().flat_map(|skipped| ["; ", skipped]));
            Error::not_found(message)
        })
    }

    /// Loads the library at `path` as the ONNX Runtime of this process.
    ///
    /// # Errors
    /// `NotFound` when there is no such file, `Format` when it is not ONNX Runtime, `Unsupported` when it is too old
    /// or another one is already loaded: a process can load only one.
    pub fn load(path: &Path) -> Result<Arc<Self>> {
        let mut search = SEARCH.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(loaded) = &search.found {
            if path.canonicalize().is_ok_and(|path| path == loaded.0.path) {
                return Ok(Arc::clone(loaded));
            }
            return Err(Error::unsupported(format!(
                "ONNX Runtime at {} is already loaded, and a process can load only one; restart to use {}",
                loaded.0.path.display(),
                path.display()
            )));
        }
        let loaded = Arc::new(Self(library::load(path)?));
        search.found = Some(Arc::clone(&loaded));
        search.done = true;
        Ok(loaded)
    }

    /// Returns the libraries that the search skipped, with the reason, one line each.
    pub fn skipped() -> Vec<String> {
        SEARCH.lock().unwrap_or_else(PoisonError::into_inner).skipped.clone()
    }

    /// Oldest supported version.
    pub const MIN_VERSION: &str = library::MIN_VERSION;

    /// Returns whether a version, e.g. `"1.31.1"`, is supported.
    pub fn is_supported(version: &str) -> bool {
        Version::parse(version).is_some_and(Version::is_supported)
    }

    /// Returns the folder within a cache folder that is searched for the library.
    pub fn cache_folder(cache: &Path) -> PathBuf {
        library::cache_folder(cache)
    }

    /// Returns whether a file name is that of the ONNX Runtime library on this system: `libonnxruntime.so.1.31.1`,
    /// not a library of its providers.
    pub fn is_library(file_name: &str) -> bool {
        library::is_library(file_name)
    }

    /// Returns the ONNX Runtime libraries in a folder, newest first.
    pub fn libraries_in(folder: &Path) -> Vec<PathBuf> {
        library::libraries_in(folder)
    }

    /// Makes the next [`OnnxRuntime::find`] search again if none was found so far, e.g. after an installation.
    pub fn reset_search() {
        let mut search = SEARCH.lock().unwrap_or_else(PoisonError::into_inner);
        search.done = search.found.is_some();
        search.skipped.clear();
    }

    /// Returns the path of the library.
    pub fn path(&self) -> &Path {
        &self.0.path
    }

    fn builder(&self, options: &SessionOptions) -> Result<SessionBuilder> {
        let threads = options.thread_count()?;
        let build = || -> ort::Result<SessionBuilder> {
            let builder = Session::builder(&self.0.environment)?;
            let builder = builder.with_optimization_level(GraphOptimizationLevel::All)?;
            let builder =
                builder.with_config_entry("session.intra_op.spin_duration_us", SPIN_MICROSECONDS)?;
            Ok(builder.with_intra_threads(threads)?)
        };
        build().map_err(|error| {
            Error::internal("ONNX Runtime rejects the session options").with_source(message_of(&error))
        })
    }

    fn open_on_cpu(&self, model: &[u8], options: &SessionOptions) -> Result<Session> {
        commit(self.builder(options)?, &suited(model))?.map_err(|error| {
            let message = "ONNX Runtime cannot open the ONNX model";
            // An unknown operator is reported as a general failure.
            let unknown = error.message().contains("No Op registered");
            match error.code() {
                _ if unknown => Error::unsupported(message),
                ort::ErrorCode::NotImplemented => Error::unsupported(message),
                _ => Error::format(message),
            }
            .with_source(message_of(&error))
        })
    }

    /// Opens a model on an accelerator, or returns why that fails.
    fn open_on(&self, device: Device, model: &[u8], options: &SessionOptions) -> Result<Session> {
        let builder = self.builder(options)?;
        let commit = |builder| commit(builder, model).map_err(|error| error.message().to_owned());
        Some(provider::providers_from_device(device))
            .filter(|_| provider::is_built_in(device))
            .ok_or_else(|| self.no_provider(device))
            .and_then(|providers| {
                builder.with_execution_providers(providers).map_err(|error| message_of(&error))
            })
            .and_then(|builder| commit(builder)?.map_err(|error| message_of(&error)))
            .map_err(|reason| {
                let devices: Vec<_> = self.devices().iter().map(ToString::to_string).collect();
                Error::device(format!(
                    "device {device} is missing or not working; available: {}",
                    devices.join(", ")
                ))
                .with_source(reason)
            })
    }

    fn no_provider(&self, device: Device) -> String {
        format!("ONNX Runtime at {} was built without {device}", self.0.path.display())
    }

    /// Returns whether `device` can be set up, as far as that can be checked without a model.
    fn is_usable(&self, device: Device) -> bool {
        provider::is_built_in(device)
            && self.builder(&SessionOptions { device, threads: 1 }).is_ok_and(|builder| {
                builder.with_execution_providers(provider::providers_from_device(device)).is_ok()
            })
    }
}

/// Opens a session of a model.
///
/// # Errors
/// `Format` when the binding of ONNX Runtime panics, as it does for outputs of an impossible shape.
fn commit(mut builder: SessionBuilder, model: &[u8]) -> Result<ort::Result<Session>> {
    catch_unwind(AssertUnwindSafe(|| builder.commit_from_memory(model)))
        .map_err(|_| Error::format("ONNX Runtime cannot open the ONNX model: its graph is damaged"))
}

impl Runtime for OnnxRuntime {
    fn name(&self) -> &'static str {
        "onnxruntime"
    }

    fn version(&self) -> String {
        self.0
            .version
            .map_or_else(|| format!("{} or later", Self::MIN_VERSION), |version| version.to_string())
    }

    fn devices(&self) -> Vec<Device> {
        let accelerators = provider::ACCELERATORS.into_iter().filter(|&device| self.is_usable(device));
        accelerators.chain([Device::Cpu]).collect()
    }

    fn open(&self, model: &[u8], options: &SessionOptions) -> Result<Box<dyn Engine>> {
        let is_small = is_small(&OnnxHeader::read(model)?.inputs, model.len());
        let options = &match options.threads == 0 && is_small {
            true => SessionOptions { threads: 1, ..*options },
            false => *options,
        };
        let (device, session) = match options.device {
            Device::Cpu => (Device::Cpu, self.open_on_cpu(model, options)?),
            Device::Auto => {
                let cuda = Device::Cuda(0);
                let on_cuda =
                    provider::is_built_in(cuda).then(|| self.open_on(cuda, model, options).ok()).flatten();
                match on_cuda {
                    Some(session) => (cuda, session),
                    None => (Device::Cpu, self.open_on_cpu(model, options)?),
                }
            }
            device => match self.open_on(device, model, options) {
                Ok(session) => (device, session),
                // A model that also fails on the CPU is itself invalid.
                Err(error) => return Err(self.open_on_cpu(model, options).err().unwrap_or(error)),
            },
        };
        Ok(Box::new(OnnxRuntimeEngine::new(session, device)?))
    }

    fn describe(&self) -> String {
        format!("ONNX Runtime {} ({})", self.version(), self.0.path.display())
    }
}

/// Product of input elements and model bytes below which a second thread costs more than it saves: keyword spotting
/// by DS-CNN (490 elements, 71 kB) takes 0.10 ms with two threads, 0.06 with one.
const ONE_THREAD: usize = 50_000_000;

/// Returns whether a run is short: each weight is used at most once per input element, except in recurrent networks,
/// which have an open dimension other than the batch.
fn is_small(inputs: &[TensorInfo], bytes: usize) -> bool {
    let numbers = |input: &TensorInfo| {
        let (batch, rest) = input.dims.split_first()?;
        rest.iter().try_fold(batch.unwrap_or(1), |numbers, size| numbers.checked_mul((*size)?))
    };
    let all = inputs.iter().try_fold(0_usize, |all, input| all.checked_add(numbers(input)?));
    all.and_then(|all| all.checked_mul(bytes)).is_some_and(|work| work < ONE_THREAD)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tensor::ElementType;

    #[test]
    fn small_networks_are_recognised_by_inputs_and_weights() {
        let input = |dims: &[Option<usize>]| TensorInfo {
            name: String::new(),
            element_type: ElementType::F32,
            dims: dims.to_vec(),
        };
        let cepstra = input(&[None, Some(1), Some(49), Some(10)]);
        assert!(is_small(std::slice::from_ref(&cepstra), 71_000));
        assert!(!is_small(&[cepstra], 10_000_000), "many weights");
        let picture = input(&[Some(1), Some(3), Some(64), Some(64)]);
        assert!(!is_small(&[picture], 52_000), "an image");
        assert!(!is_small(&[input(&[Some(1), None])], 1000), "an open length");
        assert!(!is_small(&[input(&[Some(usize::MAX), Some(2)])], 1));
    }
}
