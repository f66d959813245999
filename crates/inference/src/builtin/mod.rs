//! The built-in runtime: pure Rust (the graph executor and rten), available without any installed library.

mod engine;
mod fallback;
mod repair;
mod size_limit;
mod substitute;
mod threads;

use std::panic::{AssertUnwindSafe, catch_unwind};

use opendr_engine::{Device, Error, ErrorKind, Result};
use rten::{LoadErrorKind, ModelOptions};

use crate::executor::GraphExecutor;
use crate::onnx_header::OnnxHeader;
use crate::runtime::{Engine, Runtime, SessionOptions};
use engine::BuiltinEngine;
use fallback::{Fallback, has_open_shapes};

/// Version of rten in the workspace's manifest; rten does not expose it.
const RTEN_VERSION: &str = "0.27";

/// The built-in runtime: the graph executor for models that it supports, rten for the others. Runs on the CPU only;
/// always available.
#[derive(Debug, Clone, Copy, Default)]
pub struct Builtin;

impl Runtime for Builtin {
    fn name(&self) -> &'static str {
        "builtin"
    }

    fn version(&self) -> String {
        format!("{}, rten {RTEN_VERSION}", GraphExecutor.version())
    }

    fn devices(&self) -> Vec<Device> {
        vec![Device::Cpu]
    }

    fn open(&self, bytes: &[u8], options: &SessionOptions) -> Result<Box<dyn Engine>> {
        match GraphExecutor.open(bytes, options) {
            // Open shapes are planned in the first run, which may refuse them too.
            Ok(engine) if has_open_shapes(&*engine) => Ok(Box::new(Fallback::new(engine, bytes, *options))),
            Err(error) if error.kind() == ErrorKind::Unsupported => Rten.open(bytes, options),
            opened => opened,
        }
    }

    fn describe(&self) -> String {
        format!("built-in ({}, rten {RTEN_VERSION})", GraphExecutor.describe())
    }
}

/// The runtime of the crate rten, in pure Rust.
#[derive(Debug, Clone, Copy, Default)]
pub struct Rten;

impl Runtime for Rten {
    fn name(&self) -> &'static str {
        "rten"
    }

    fn version(&self) -> String {
        format!("rten {RTEN_VERSION}")
    }

    fn devices(&self) -> Vec<Device> {
        vec![Device::Cpu]
    }

    fn open(&self, bytes: &[u8], options: &SessionOptions) -> Result<Box<dyn Engine>> {
        if !matches!(options.device, Device::Auto | Device::Cpu) {
            return Err(Error::device(format!(
                "the built-in runtime does not support device {}, only cpu; install ONNX Runtime for other devices",
                options.device
            )));
        }
        let header = OnnxHeader::read(bytes)?;
        size_limit::check_constants(bytes)?;
        let model = repair::repaired(bytes)?.into_owned();
        let mut load = ModelOptions::with_all_ops();
        load.prepack_weights(true);
        // rten validates most of its input, not all: the rest panics, and must not end the process.
        let model = catch_unwind(AssertUnwindSafe(|| load.load(model)))
            .map_err(|_| {
                Error::format("the built-in runtime cannot read the ONNX model: its graph is damaged")
            })?
            .map_err(|error| {
                let message = "the built-in runtime cannot open the ONNX model";
                match error.kind() {
                    LoadErrorKind::OperatorInvalid => Error::unsupported(message),
                    _ => Error::format(message),
                }
                .with_source(error)
            })?;
        size_limit::check_shapes(&model, bytes)?;
        let threads = threads::pool(options.thread_count()?);
        Ok(Box::new(BuiltinEngine::new(model, header, threads)?))
    }

    fn describe(&self) -> String {
        format!("rten {RTEN_VERSION}")
    }
}
