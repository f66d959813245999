//! An opened model: the one door between learners and runtimes.

use std::fmt;
use std::sync::{Mutex, PoisonError};
use std::time::Instant;

use opendr_engine::{Device, Error, Result};

use crate::runtime::{Engine, Runtime, SessionOptions};
use crate::tensor::{TensorInfo, TensorView};
use crate::{recording, selection, timing};

/// An opened model. One session serves many threads, one run at a time.
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
}

impl Session {
    /// Opens an ONNX model with the best runtime there is for the device ([`crate::default_runtime`]).
    ///
    /// `options` is a [`Device`], or [`SessionOptions`] to say more. `OPENDR_DEVICE` overrides the device.
    ///
    /// # Errors
    /// `Format` when the bytes are no ONNX model, `Unsupported` when no runtime has what it needs, `Device` when
    /// the device is not there.
    pub fn open(model: &[u8], options: impl Into<SessionOptions>) -> Result<Self> {
        let mut options = options.into();
        options.device = options.device.or_environment()?;
        Self::open_with(&*selection::default_runtime(options.device)?, model, options)
    }

    /// Opens an ONNX model with `runtime`.
    ///
    /// # Errors
    /// As [`Session::open`].
    pub fn open_with(
        runtime: &dyn Runtime,
        model: &[u8],
        options: impl Into<SessionOptions>,
    ) -> Result<Self> {
        Ok(Self::with_name(runtime.open(model, &options.into())?, runtime.name()))
    }

    /// A session over an engine of the caller's own: a recording in a test, an accelerator's library.
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
        }
    }

    /// What [`Session::run`] takes, in order.
    pub fn inputs(&self) -> &[TensorInfo] {
        &self.inputs
    }

    /// What [`Session::run`] gives, in order.
    pub fn outputs(&self) -> &[TensorInfo] {
        &self.outputs
    }

    /// Where the output called `name` stands among [`Session::outputs`].
    ///
    /// # Errors
    /// `Format` that lists the outputs there are: a learner met another model than it was written for.
    pub fn output_index(&self, name: &str) -> Result<usize> {
        self.outputs.iter().position(|output| output.name == name).ok_or_else(|| {
            let names: Vec<_> = self.outputs.iter().map(|output| output.name.as_str()).collect();
            Error::format(format!("the model has no output {name:?}, only {}", names.join(", ")))
        })
    }

    /// The name of the runtime that opened it, or `"custom"`.
    pub fn runtime(&self) -> &'static str {
        self.runtime
    }

    /// The device it runs on.
    pub fn device(&self) -> Device {
        self.device
    }

    /// Runs the model on `inputs`, in the order of [`Session::inputs`], and hands the outputs, in the order of
    /// [`Session::outputs`], to `sink`, where they lie and only while it runs.
    ///
    /// Allocates nothing beyond what the engine does. Other threads wait until `sink` has returned; `sink` must not
    /// run this session again.
    ///
    /// # Errors
    /// `InvalidInput` when an input does not fit, else what the engine or `sink` return.
    pub fn run(
        &self,
        inputs: &[TensorView<'_>],
        mut sink: impl FnMut(&[TensorView<'_>]) -> Result<()>,
    ) -> Result<()> {
        if inputs.len() != self.inputs.len() {
            return Err(Error::invalid_input(format!(
                "the model takes {} inputs, was given {}",
                self.inputs.len(),
                inputs.len()
            )));
        }
        self.inputs.iter().zip(inputs).try_for_each(|(info, input)| info.check(input))?;
        recording::add(&self.inputs, &self.outputs, inputs);
        // A panic in an earlier sink leaves the engine whole.
        let mut engine = self.engine.lock().unwrap_or_else(PoisonError::into_inner);
        let start = Instant::now();
        engine.run(inputs, &mut |outputs| {
            timing::add(start, Instant::now());
            if outputs.len() != self.outputs.len() {
                return Err(Error::internal(format!(
                    "the engine gave {} outputs instead of {}",
                    outputs.len(),
                    self.outputs.len()
                )));
            }
            sink(outputs)
        })
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
