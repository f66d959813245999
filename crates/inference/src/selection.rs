//! Which runtime opens a model.

use std::sync::Arc;

use opendr_engine::{Device, Error, Result};

use crate::builtin::Builtin;
use crate::measured::SLOWER_THAN_ONNX_RUNTIME;
use crate::onnx_runtime::OnnxRuntime;
use crate::runtime::{Runtime, SessionOptions};

/// What `OPENDR_RUNTIME` asks for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Wish {
    Auto,
    OnnxRuntime,
    Builtin,
}

impl Wish {
    fn from_environment() -> Result<Self> {
        match std::env::var("OPENDR_RUNTIME").as_deref() {
            Err(_) | Ok("" | "auto") => Ok(Self::Auto),
            Ok("onnxruntime") => Ok(Self::OnnxRuntime),
            Ok("builtin") => Ok(Self::Builtin),
            Ok(other) => Err(Error::invalid_param(format!(
                "environment variable OPENDR_RUNTIME is {other:?}; give one of auto, onnxruntime, builtin"
            ))),
        }
    }
}

/// The runtimes that are there, best first.
pub fn runtimes() -> Vec<Arc<dyn Runtime>> {
    let onnx_runtime = OnnxRuntime::find().ok().map(|runtime| runtime as Arc<dyn Runtime>);
    onnx_runtime.into_iter().chain([Arc::new(Builtin) as Arc<dyn Runtime>]).collect()
}

/// The runtime that [`crate::Session::open`] takes for `device`: ONNX Runtime where its library is found, else the
/// built-in one. `OPENDR_RUNTIME` (`auto`, `onnxruntime`, `builtin`) overrides that.
///
/// # Errors
/// `NotFound` when ONNX Runtime is demanded and not there, `Device` when only ONNX Runtime could have the device and
/// it is not there, `InvalidParam` when `OPENDR_RUNTIME` names no runtime.
pub fn default_runtime(device: Device) -> Result<Arc<dyn Runtime>> {
    let found = match Wish::from_environment()? {
        Wish::Builtin => return Ok(Arc::new(Builtin)),
        Wish::OnnxRuntime => return Ok(OnnxRuntime::find()?),
        Wish::Auto => OnnxRuntime::find(),
    };
    match found {
        Ok(runtime) => Ok(runtime),
        Err(_) if matches!(device, Device::Auto | Device::Cpu) => Ok(Arc::new(Builtin)),
        Err(error) => Err(Error::device(format!(
            "device {device} needs ONNX Runtime; the built-in runtime has: {}",
            Device::Cpu
        ))
        .with_source(error)),
    }
}

/// The device that [`crate::Session::open`] takes for `device`: itself, or the best one there is for `Auto`.
/// `OPENDR_DEVICE` overrides it.
///
/// # Errors
/// As [`default_runtime`].
pub fn device(device: Device) -> Result<Device> {
    let wanted = device.or_environment()?;
    Ok(resolved(&*default_runtime(wanted)?, wanted))
}

fn resolved(runtime: &dyn Runtime, wanted: Device) -> Device {
    let best = || runtime.devices().first().copied().unwrap_or(Device::Cpu);
    if wanted == Device::Auto { best() } else { wanted }
}

/// One line for people about the runtime in use: `ONNX Runtime 1.31.1 (/path/libonnxruntime.so), cpu, 2 threads`.
///
/// # Errors
/// As [`default_runtime`].
pub fn describe(options: impl Into<SessionOptions>) -> Result<String> {
    let options = options.into();
    let wanted = options.device.or_environment()?;
    let runtime = default_runtime(wanted)?;
    let device = resolved(&*runtime, wanted);
    let threads = options.thread_count()?;
    let plural = if threads == 1 { "" } else { "s" };
    let mut line = format!("{}, {device}, {threads} thread{plural}", runtime.describe());
    if runtime.name() == Builtin.name() && Wish::from_environment()? == Wish::Auto {
        let [least, most] = SLOWER_THAN_ONNX_RUNTIME;
        line.push_str(&format!(
            "; ONNX Runtime was {least} to {most} times faster on detectors, measured: run \"opendr runtime install\""
        ));
        line.extend(OnnxRuntime::skipped().iter().flat_map(|skipped| ["; passed over: ", skipped]));
    }
    Ok(line)
}
