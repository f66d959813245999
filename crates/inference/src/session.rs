//! Opened models: the interface between learners and runtimes.

use std::fmt;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};
use std::time::Instant;

use opendr_engine::{Device, Error, Result};

use crate::runtime::{Engine, Runtime, SessionOptions};
use crate::tensor::{TensorInfo, TensorView};
use crate::{layers, recording, selection, timing};

/// An opened model. Threads can share a session; runs are serialised.
///
/// ```no_run
/// # fn main() -> opendr_engine::Result<()> {
/// use opendr_engine::Device;
/// use opendr_inference::{Session, TensorView};
///
/// let session = Session::open(&std::fs::read("nanodet.onnx")?, Device::Auto)?;
/// let pixels = vec![0.0_f32; 3 * 416 * 416];
/// session.run(&[TensorView::new(&[1, 3, 416, 416], &pixels)?], |outputs| {
///     println!("{:?}", outputs[0].values::<f32>()?.first());
///     Ok(())
/// })?;
/// # Ok(())
/// # }
/// ```
pub struct Session {
    engine: Mutex<Box<dyn Engine>>,
    inputs: Vec<TensorInfo>,
    outputs: Vec<TensorInfo>,
    device: Device,
    runtime: &'static str,
    /// Number among the sessions of the process.
    number: usize,
}

static SESSIONS: AtomicUsize = AtomicUsize::new(0);

impl Session {
    /// Opens an ONNX model with the best available runtime for the device ([`crate::default_runtime`]).
    ///
    /// `options` is a [`Device`] or [`SessionOptions`]. `OPENDR_DEVICE` overrides the device.
    ///
    /// # Errors
    /// `Format` when the bytes are not an ONNX model, `Unsupported` when the runtime lacks an operator or type of the
    /// model, `Device` when the device is not available.
    pub fn open(model: &[u8], options: impl Into<SessionOptions>) -> Result<Self> {
        let mut options = options.into();
        options.device = options.device.or_environment()?;
        Self::open_with(&*selection::default_runtime(options.device)?, model, options)
    }

    /// Opens an ONNX model with `runtime`.
    ///
    /// # Errors
    /// Those of [`Session::open`].
    pub fn open_with(
        runtime: &dyn Runtime,
        model: &[u8],
        options: impl Into<SessionOptions>,
    ) -> Result<Self> {
        Ok(Self::with_name(runtime.open(model, &options.into())?, runtime.name()))
    }

    /// Creates a session over a custom engine, such as a mock in a test or the library of an accelerator.
    pub fn from_engine(engine: Box<dyn Engine>) -> Self {
        Self::with_name(engine, "custom")
    }

    fn with_name(engine: Box<dyn Engine>, runtime: &'static str) -> Self {
        Self {
            inputs: engine.inputs().to_vec(),
            outputs: engine.outputs().to_vec(),
            device: engine.device(),
            engine: Mutex::new(engine),
            runtime,
            number: SESSIONS.fetch_add(1, Ordering::Relaxed),
        }
    }

    /// Returns the declared inputs of [`Session::run`], in order.
    pub fn inputs(&self) -> &[TensorInfo] {
        &self.inputs
    }

    /// Returns the declared outputs of [`Session::run`], in order.
    pub fn outputs(&self) -> &[TensorInfo] {
        &self.outputs
    }

    /// Returns the index of the output called `name` in [`Session::outputs`].
    ///
    /// # Errors
    /// `Format` with the existing outputs, when the model has no such output.
    pub fn output_index(&self, name: &str) -> Result<usize> {
        self.outputs.iter().position(|output| output.name == name).ok_or_else(|| {
            let names: Vec<_> = self.outputs.iter().map(|output| output.name.as_str()).collect();
            Error::format(format!("the model has no output {name:?}; its outputs are {}", names.join(", ")))
        })
    }

    /// Returns the name of the runtime of the session, or `"custom"`.
    pub fn runtime(&self) -> &'static str {
        self.runtime
    }

    /// Returns the device of the session.
    pub fn device(&self) -> Device {
        self.device
    }

    /// Runs the model on `inputs`, in the order of [`Session::inputs`], and calls `sink` with the outputs, in the
    /// order of [`Session::outputs`]. The outputs are borrowed and valid only during the call.
    ///
    /// Allocates nothing beyond the allocations of the engine. Other threads wait until `sink` has returned; `sink`
    /// must not run this session again.
    ///
    /// # Errors
    /// `InvalidInput` when an input does not match its declaration, and the errors of the engine and of `sink`.
    pub fn run(
        &self,
        inputs: &[TensorView<'_>],
        mut sink: impl FnMut(&[TensorView<'_>]) -> Result<()>,
    ) -> Result<()> {
        if inputs.len() != self.inputs.len() {
            return Err(Error::invalid_input(format!(
                "the model has {} inputs, but received {}",
                self.inputs.len(),
                inputs.len()
            )));
        }
        self.inputs.iter().zip(inputs).try_for_each(|(info, input)| info.check(input))?;
        let recorded = recording::add(&self.inputs, &self.outputs, inputs);
        // A panic in an earlier sink does not affect the engine.
        let mut engine = self.engine.lock().unwrap_or_else(PoisonError::into_inner);
        let start = Instant::now();
        let mut sink = |outputs: &[TensorView<'_>]| {
            timing::add(start, Instant::now());
            if outputs.len() != self.outputs.len() {
                return Err(Error::internal(format!(
                    "the engine returned {} outputs instead of {}",
                    outputs.len(),
                    self.outputs.len()
                )));
            }
            if let Some(run) = recorded {
                recording::add_outputs(run, outputs);
            }
            sink(outputs)
        };
        if !layers::is_on() {
            return engine.run(inputs, &mut sink);
        }
        let profile = engine.profile(inputs, &mut sink)?;
        layers::add(self.number, profile);
        Ok(())
    }
}

impl fmt::Debug for Session {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Session")
            .field("runtime", &self.runtime)
            .field("device", &self.device)
            .field("inputs", &self.inputs)
            .field("outputs", &self.outputs)
            .finish_non_exhaustive()
    }
}
