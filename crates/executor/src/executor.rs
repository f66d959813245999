//! An opened model: plans, memory and runs.

use std::time::{Duration, Instant};

use opendr_engine::{Error, Result};
use opendr_kernels::{Arena, Compute, LayerCost};

use crate::constant::Given;
use crate::declared::Declared;
use crate::reading::Model;
use crate::run::{Observe, Run};
use crate::stages::Stages;
use crate::tensor::{Kind, Tensor};

/// An opened model.
pub struct Executor {
    inputs: Vec<Declared>,
    outputs: Vec<Declared>,
    stages: Stages,
    compute: Compute,
    arena: Arena,
}

/// Measurement of a step of a run. A node has as many as it has steps.
#[derive(Debug, Clone)]
pub struct LayerProfile {
    /// Name of the first output of the node.
    pub name: String,
    /// Operator of the node.
    pub operator: String,
    /// Time at which the step began.
    pub start: Instant,
    /// Duration.
    pub time: Duration,
    /// Arithmetic of products, and bytes of packed weights; zero for operators without products.
    pub cost: LayerCost,
    /// Bytes of the tensors that the step reads and writes.
    pub tensor_bytes: u64,
}

impl Executor {
    /// Opens an ONNX model. Where the shapes of the inputs are declared, it is planned at once.
    ///
    /// # Errors
    /// `Format` when the bytes are not an ONNX model, `Unsupported` with the operator or type that the executor lacks.
    pub fn open(model: &[u8], compute: Compute) -> Result<Self> {
        let Model { graph, inputs, outputs } = Model::read(model)?;
        let shape = |input: &Declared| {
            let shape = input.dims.iter().copied().collect::<Option<Vec<usize>>>()?;
            Some(Given { kind: input.kind, shape, value: None })
        };
        let given: Option<Vec<Given>> = inputs.iter().map(shape).collect();
        let (mut stages, mut arena) = (Stages::new(graph), Arena::new(0));
        if let Some(given) = given {
            stages.prepare(&compute, &mut arena, given)?;
        }
        Ok(Self { inputs, outputs, stages, compute, arena })
    }

    /// Returns the names and element types of the inputs.
    pub fn inputs(&self) -> impl Iterator<Item = (&str, Kind)> {
        self.inputs.iter().map(|input| (input.name.as_str(), input.kind))
    }

    /// Returns the declared dimensions of the inputs, `None` where one is open.
    pub fn input_shapes(&self) -> impl Iterator<Item = &[Option<usize>]> {
        self.inputs.iter().map(|input| input.dims.as_slice())
    }

    /// Returns the names and element types of the outputs.
    pub fn outputs(&self) -> impl Iterator<Item = (&str, Kind)> {
        self.outputs.iter().map(|output| (output.name.as_str(), output.kind))
    }

    /// Returns whether the model has a plan, which it has from the beginning where the shapes of its inputs are
    /// declared.
    pub fn is_planned(&self) -> bool {
        self.stages.is_planned()
    }

    /// Returns the bytes of the memory in which tensors lie.
    pub fn arena_bytes(&self) -> usize {
        self.arena.bytes()
    }

    /// Runs the model once on `inputs`, in their declared order, and calls `sink` once with the outputs.
    ///
    /// # Errors
    /// `InvalidInput` when number, type or shape of the inputs do not fit, `Unsupported` and `Format` when the model
    /// cannot be planned for these shapes, and those of `sink`.
    pub fn run(
        &mut self,
        inputs: &[Tensor<'_>],
        sink: &mut dyn FnMut(&[Tensor<'_>]) -> Result<()>,
    ) -> Result<()> {
        self.run_observed(inputs, sink, &mut |_, _| ())
    }

    /// Runs the model as [`Executor::run`] does, and returns the measurements of its steps, in their order. Steps within branches and
    /// loops count as one.
    ///
    /// # Errors
    /// Those of [`Executor::run`].
    pub fn profile(
        &mut self,
        inputs: &[Tensor<'_>],
        sink: &mut dyn FnMut(&[Tensor<'_>]) -> Result<()>,
    ) -> Result<Vec<LayerProfile>> {
        let mut layers = Vec::new();
        let mut start = Instant::now();
        self.run_observed(inputs, sink, &mut |node, cost| {
            let time = start.elapsed();
            let (cost, tensor_bytes) = cost();
            let name = node.output.first().cloned().unwrap_or_default();
            let operator = node.op_type.clone();
            layers.push(LayerProfile { name, operator, start, time, cost, tensor_bytes });
            start = Instant::now();
        })?;
        Ok(layers)
    }

    fn run_observed(
        &mut self,
        inputs: &[Tensor<'_>],
        sink: &mut dyn FnMut(&[Tensor<'_>]) -> Result<()>,
        observe: &mut Observe<'_>,
    ) -> Result<()> {
        self.check(inputs)?;
        let mut run = Run { arena: &mut self.arena, compute: &self.compute, looped: 0, observe };
        self.stages.run(&mut run, inputs, sink)
    }

    fn check(&self, inputs: &[Tensor<'_>]) -> Result<()> {
        let declared = &self.inputs;
        if declared.len() != inputs.len() {
            return Err(Error::invalid_input(format!(
                "the model has {} inputs, but received {}",
                declared.len(),
                inputs.len()
            )));
        }
        for (declared, input) in declared.iter().zip(inputs) {
            let elements = input.shape.iter().try_fold(1_usize, |count, &dim| count.checked_mul(dim));
            if declared.kind != input.data.kind() || elements != Some(input.data.len()) {
                return Err(Error::invalid_input(format!(
                    "model input {:?} of {:?} received {} elements of {:?} for the shape {:?}",
                    declared.name,
                    declared.kind,
                    input.data.len(),
                    input.data.kind(),
                    input.shape
                )));
            }
        }
        Ok(())
    }
}

impl std::fmt::Debug for Executor {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Executor")
            .field("inputs", &self.inputs)
            .field("outputs", &self.outputs)
            .finish_non_exhaustive()
    }
}
