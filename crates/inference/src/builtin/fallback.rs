//! Models of open shapes: the graph executor plans them in a run, and rten takes over what it refuses.

use opendr_engine::{ErrorKind, Result};

use super::rten_runtime::Rten;
use crate::runtime::{Engine, Runtime, SessionOptions, Sink};
use crate::tensor::{TensorInfo, TensorView};

/// Returns whether the shape of an input is not declared in full.
pub(super) fn has_open_shapes(engine: &dyn Engine) -> bool {
    engine.inputs().iter().any(|input| input.dims.iter().any(Option::is_none))
}

pub(super) struct Fallback {
    engine: Box<dyn Engine>,
    /// The model, until a run has succeeded.
    model: Option<Vec<u8>>,
    options: SessionOptions,
}

impl Fallback {
    pub(super) fn new(engine: Box<dyn Engine>, model: &[u8], options: SessionOptions) -> Self {
        Self { engine, model: Some(model.to_vec()), options }
    }
}

impl Engine for Fallback {
    fn inputs(&self) -> &[TensorInfo] {
        self.engine.inputs()
    }

    fn outputs(&self) -> &[TensorInfo] {
        self.engine.outputs()
    }

    fn run(&mut self, inputs: &[TensorView<'_>], sink: &mut Sink<'_>) -> Result<()> {
        let Some(model) = self.model.take() else { return self.engine.run(inputs, sink) };
        let mut is_done = false;
        let ran = self.engine.run(inputs, &mut |outputs| {
            is_done = true;
            sink(outputs)
        });
        match ran {
            Err(error) if !is_done && matches!(error.kind(), ErrorKind::Unsupported | ErrorKind::Format) => {
                self.engine = Rten.open(&model, &self.options)?;
                self.engine.run(inputs, sink)
            }
            Err(error) if !is_done => {
                self.model = Some(model);
                Err(error)
            }
            ran => ran,
        }
    }
}
