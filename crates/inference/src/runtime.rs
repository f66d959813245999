//! The two roles behind a session: a runtime opens models, an engine runs one of them.

use opendr_engine::{Device, Result};

use crate::tensor::{TensorInfo, TensorView};
use crate::threads::default_threads;

/// A library that opens models.
pub trait Runtime: Send + Sync {
    /// The name for `OPENDR_RUNTIME` and messages, e.g. `"onnxruntime"`.
    fn name(&self) -> &'static str;

    /// The version of the library behind it.
    fn version(&self) -> String;

    /// The devices it can open a model on, best first.
    fn devices(&self) -> Vec<Device>;

    /// Opens an ONNX model. [`SessionOptions::device`] may be `Auto`.
    ///
    /// # Errors
    /// `Format` when the bytes are no ONNX model, `Unsupported` when the runtime lacks an operator or type that
    /// the model uses, `Device` when the device is not there.
    fn open(&self, model: &[u8], options: &SessionOptions) -> Result<Box<dyn Engine>>;

    /// One line for people: name, version, where it is from.
    fn describe(&self) -> String {
        format!("{} {}", self.name(), self.version())
    }
}

/// One opened model. Third parties and tests bring their own through [`crate::Session::from_engine`].
pub trait Engine: Send {
    /// What [`Engine::run`] takes, in order.
    fn inputs(&self) -> &[TensorInfo];

    /// What [`Engine::run`] gives, in order.
    fn outputs(&self) -> &[TensorInfo];

    /// Runs once on `inputs`, which fit [`Engine::inputs`], and calls `sink` once with the outputs where they lie.
    ///
    /// # Errors
    /// What the engine meets, and what `sink` returns.
    fn run(&mut self, inputs: &[TensorView<'_>], sink: &mut Sink<'_>) -> Result<()>;

    /// The device it runs on.
    fn device(&self) -> Device {
        Device::Cpu
    }
}

/// Sees the outputs of a run, in the order of [`Engine::outputs`], while they last.
pub type Sink<'a> = dyn FnMut(&[TensorView<'_>]) -> Result<()> + 'a;

/// How a model is opened.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct SessionOptions {
    /// Where it runs.
    pub device: Device,
    /// Threads that work on one run; 0 takes [`crate::default_threads`], or one where more would only cost time.
    pub threads: usize,
}

impl SessionOptions {
    /// The number of threads to use, at least 1.
    ///
    /// # Errors
    /// As [`crate::default_threads`].
    pub fn thread_count(&self) -> Result<usize> {
        if self.threads > 0 { Ok(self.threads) } else { default_threads() }
    }
}

impl From<Device> for SessionOptions {
    fn from(device: Device) -> Self {
        Self { device, threads: 0 }
    }
}
