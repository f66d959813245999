//! The interface behind a session: a runtime opens models, an engine runs one of them.

use opendr_engine::{Device, Result};
use opendr_executor::LayerProfile;

use crate::tensor::{TensorInfo, TensorView};
use crate::threads::default_threads;

/// A library that opens models.
pub trait Runtime: Send + Sync {
    /// Returns the name for `OPENDR_RUNTIME` and messages, e.g. `"onnxruntime"`.
    fn name(&self) -> &'static str;

    /// Returns the version of the underlying library.
    fn version(&self) -> String;

    /// Returns the available devices, best first.
    fn devices(&self) -> Vec<Device>;

    /// Opens an ONNX model. [`SessionOptions::device`] may be `Auto`.
    ///
    /// # Errors
    /// `Format` when the bytes are not an ONNX model, `Unsupported` when the runtime lacks an operator or type of the
    /// model, `Device` when the device is not available.
    fn open(&self, model: &[u8], options: &SessionOptions) -> Result<Box<dyn Engine>>;

    /// Returns a one-line description: name, version, location.
    fn describe(&self) -> String {
        format!("{} {}", self.name(), self.version())
    }
}

/// An opened model. Custom engines are used through [`crate::Session::from_engine`].
pub trait Engine: Send {
    /// Returns the declared inputs of [`Engine::run`], in order.
    fn inputs(&self) -> &[TensorInfo];

    /// Returns the declared outputs of [`Engine::run`], in order.
    fn outputs(&self) -> &[TensorInfo];

    /// Runs the model once on `inputs`, which match [`Engine::inputs`], and calls `sink` once with the outputs in
    /// place.
    ///
    /// # Errors
    /// Those of the engine, and those that `sink` returns.
    fn run(&mut self, inputs: &[TensorView<'_>], sink: &mut Sink<'_>) -> Result<()>;

    /// Runs the model as [`Engine::run`] does, and returns the measurements of its steps; none where the engine has no profiler.
    ///
    /// # Errors
    /// Those of [`Engine::run`].
    fn profile(&mut self, inputs: &[TensorView<'_>], sink: &mut Sink<'_>) -> Result<Vec<LayerProfile>> {
        self.run(inputs, sink).map(|()| Vec::new())
    }

    /// Returns the device of the engine.
    fn device(&self) -> Device {
        Device::Cpu
    }
}

/// A callback that receives the outputs of a run, in the order of [`Engine::outputs`], for the duration of the call.
pub type Sink<'a> = dyn FnMut(&[TensorView<'_>]) -> Result<()> + 'a;

/// Options for opening a model.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct SessionOptions {
    /// Device of the session.
    pub device: Device,
    /// Number of threads per run; 0 selects [`crate::default_threads`], or one thread where more would be slower.
    pub threads: usize,
}

impl SessionOptions {
    /// Returns the number of threads to use, at least 1.
    ///
    /// # Errors
    /// Those of [`crate::default_threads`].
    pub fn thread_count(&self) -> Result<usize> {
        if self.threads > 0 { Ok(self.threads) } else { default_threads() }
    }
}

impl From<Device> for SessionOptions {
    fn from(device: Device) -> Self {
        Self { device, threads: 0 }
    }
}
