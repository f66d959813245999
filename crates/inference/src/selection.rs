//! Selection of the runtime of a model.

use std::sync::Arc;

use opendr_engine::{Device, Error, Result};

use crate::builtin::Builtin;
use crate::measured::TIME_TO_ONNX_RUNTIME;
use crate::onnx_runtime::OnnxRuntime;
use crate::runtime::{Runtime, SessionOptions};

/// Value of `OPENDR_RUNTIME`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum RuntimeChoice {
    Auto,
    OnnxRuntime,
    Builtin,
}

impl RuntimeChoice {
    fn from_environment() -> Result<Self> {
        match std::env::var("OPENDR_RUNTIME").as_deref() {
            Err(_) | Ok("" | "auto") => Ok(Self::Auto),
            Ok("onnxruntime") => Ok(Self::OnnxRuntime),
            Ok("builtin") => Ok(Self::Builtin),
            Ok(other) => Err(Error::invalid_param(format!(
                "environment variable OPENDR_RUNTIME is {other:?}; set it to one of auto, onnxruntime, builtin"
            ))),
        }
    }
}

/// Returns the available runtimes, best first.
pub fn runtimes() -> Vec<Arc<dyn Runtime>> {
    let onnx_runtime = OnnxRuntime::find().ok().map(|runtime| runtime as Arc<dyn Runtime>);
    onnx_runtime.into_iter().chain([Arc::new(Builtin) as Arc<dyn Runtime>]).collect()
}

/// Returns the runtime that [`crate::Session::open`] uses for `device`: ONNX Runtime where its library is found, else
/// the built-in one. `OPENDR_RUNTIME` (`auto`, `onnxruntime`, `builtin`) overrides the choice.
///
/// # Errors
/// `NotFound` when ONNX Runtime is requested and missing, `Device` when the device needs ONNX Runtime and it is
/// missing, `InvalidParam` when `OPENDR_RUNTIME` has an unknown value.
pub fn default_runtime(device: Device) -> Result<Arc<dyn Runtime>> {
    let found = match RuntimeChoice::from_environment()? {
        RuntimeChoice::Builtin => return Ok(Arc::new(Builtin)),
        RuntimeChoice::OnnxRuntime => return Ok(OnnxRuntime::find()?),
        RuntimeChoice::Auto => OnnxRuntime::find(),
    };
    match found {
        Ok(runtime) => Ok(runtime),
        Err(_) if matches!(device, Device::Auto | Device::Cpu) => Ok(Arc::new(Builtin)),
        Err(error) => Err(Error::device(format!(
            "device {device} needs ONNX Runtime; the built-in runtime supports: {}",
            Device::Cpu
        ))
        .with_source(error)),
    }
}

/// Returns the device that [`crate::Session::open`] uses for `device`: itself, or the best available one for `Auto`.
/// `OPENDR_DEVICE` overrides it.
///
/// # Errors
/// Those of [`default_runtime`].
pub fn device(device: Device) -> Result<Device> {
    let wanted = device.or_environment()?;
    Ok(resolved(&*default_runtime(wanted)?, wanted))
}

fn resolved(runtime: &dyn Runtime, wanted: Device) -> Device {
    let best = || runtime.devices().first().copied().unwrap_or(Device::Cpu);
    if wanted == Device::Auto { best() } else { wanted }
}

/// Returns a one-line description of the runtime in use:
/// `ONNX Runtime 1.31.1 (/path/libonnxruntime.so), cpu, 2 threads`.
///
/// # Errors
/// Those of [`default_runtime`].
pub fn describe(options: impl Into<SessionOptions>) -> Result<String> {
    let options = options.into();
    let wanted = options.device.or_environment()?;
    let runtime = default_runtime(wanted)?;
    let device = resolved(&*runtime, wanted);
    let threads = options.thread_count()?;
    let plural = if threads == 1 { "" } else { "s" };
    let mut line = format!("{}, {device}, {threads} thread{plural}", runtime.describe());
    if runtime.name() == Builtin.name() && RuntimeChoice::from_environment()? == RuntimeChoice::Auto {
        let [least, most] = TIME_TO_ONNX_RUNTIME;
        line.push_str(&format!(
            "; takes {least:.1} to {most:.1} times as long as ONNX Runtime (measured on detectors), which \"opendr runtime install\" installs"
        ));
        line.extend(OnnxRuntime::skipped().iter().flat_map(|skipped| ["; skipped: ", skipped]));
    }
    Ok(line)
}
