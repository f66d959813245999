//! The built-in runtime: pure Rust (the graph executor and rten), available without any installed library.

mod engine;
mod fallback;
mod repair;
mod rten_runtime;
mod size_limit;
mod substitute;
mod threads;

use opendr_engine::{Device, Result};

use crate::executor::GraphExecutor;
use crate::runtime::{Engine, Runtime, SessionOptions};
use fallback::{Fallback, has_open_shapes};
use rten_runtime::RTEN_VERSION;
pub use rten_runtime::Rten;

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
            Ok(engine) => Ok(engine),
            Err(_) => Rten.open(bytes, options),
        }
    }

    fn describe(&self) -> String {
        format!("built-in ({}, rten {RTEN_VERSION})", GraphExecutor.describe())
    }
}
