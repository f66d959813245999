//! The runtime of the crate rten, in pure Rust.

use std::panic::{AssertUnwindSafe, catch_unwind};

use opendr_engine::{Device, Error, Result};
use rten::{LoadErrorKind, ModelOptions};

use super::engine::BuiltinEngine;
use super::{repair, size_limit, threads};
use crate::onnx_header::OnnxHeader;
use crate::runtime::{Engine, Runtime, SessionOptions};

/// Version of rten in the workspace's manifest; rten does not expose it.
pub(super) const RTEN_VERSION: &str = "0.27";

/// rten: runs what the graph executor refuses.
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
