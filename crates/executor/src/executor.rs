//! An opened model: plans, memory and runs.

use std::sync::Arc;
use std::time::{Duration, Instant};

use opendr_engine::{Error, Result};
use opendr_kernels::{Arena, Compute};

use crate::graph::Graph;
use crate::ops;
use crate::plan::Plan;
use crate::tensor::{Kind, Tensor};

/// Plans for different shapes that are kept.
const MAX_PLANS: usize = 8;

/// An opened model. Clones share the weights; each has memory of its own.
pub struct Executor {
    graph: Arc<Graph>,
    compute: Compute,
    /// The plan that was used last comes last.
    plans: Vec<Plan>,
    arena: Arena,
}

/// Time of the steps of a node.
#[derive(Debug, Clone)]
pub struct LayerTime {
    /// Name of the node.
    pub name: String,
    /// Operator.
    pub operator: String,
    /// Time of the last run.
    pub time: Duration,
}

impl Executor {
    /// Opens an ONNX model. Where the shapes of the inputs are declared, it is planned at once.
    ///
    /// # Errors
    /// `Format` when the bytes are not an ONNX model, `Unsupported` with the operator or type that the executor lacks.
    pub fn open(model: &[u8], compute: Compute) -> Result<Self> {
        let graph = Arc::new(Graph::read(model, ops::is_supported)?);
        let mut executor = Self { graph, compute, plans: Vec::new(), arena: Arena::new(0) };
        let shapes: Option<Vec<Vec<usize>>> =
            executor.graph.inputs.iter().map(|input| input.dims.iter().copied().collect()).collect();
        if let Some(shapes) = shapes {
            executor.plan(shapes)?;
        }
        Ok(executor)
    }

    /// Returns the names and element types of the inputs.
    pub fn inputs(&self) -> impl Iterator<Item = (&str, Kind)> {
        self.graph.inputs.iter().map(|input| (input.name.as_str(), input.kind))
    }

    /// Returns the declared dimensions of the inputs, `None` where one is open.
    pub fn input_shapes(&self) -> impl Iterator<Item = &[Option<usize>]> {
        self.graph.inputs.iter().map(|input| input.dims.as_slice())
    }

    /// Returns the names and element types of the outputs.
    pub fn outputs(&self) -> impl Iterator<Item = (&str, Kind)> {
        self.graph.outputs.iter().map(|output| (output.name.as_str(), output.kind))
    }

    /// Returns whether the model has a plan, which it has from the beginning where the shapes of its inputs are
    /// declared.
    pub fn is_planned(&self) -> bool {
        !self.plans.is_empty()
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
        self.run_observed(inputs, sink, |_| ())
    }

    /// Runs the model once, and returns the time of every node that has steps, in their order.
    ///
    /// # Errors
    /// Those of [`Executor::run`].
    pub fn profile(&mut self, inputs: &[Tensor<'_>]) -> Result<Vec<LayerTime>> {
        let mut times: Vec<(usize, Duration)> = Vec::new();
        let mut last = Instant::now();
        self.run_observed(inputs, &mut |_| Ok(()), |node| {
            let now = Instant::now();
            times.push((node, now - last));
            last = now;
        })?;
        let named = |(node, time): (usize, Duration)| {
            let node = self.graph.nodes.get(node);
            let text = |value: Option<&String>| value.cloned().unwrap_or_default();
            LayerTime {
                name: text(node.and_then(|node| node.output.first())),
                operator: text(node.map(|node| &node.op_type)),
                time,
            }
        };
        Ok(times.into_iter().map(named).collect())
    }

    fn run_observed(
        &mut self,
        inputs: &[Tensor<'_>],
        sink: &mut dyn FnMut(&[Tensor<'_>]) -> Result<()>,
        observe: impl FnMut(usize),
    ) -> Result<()> {
        self.check(inputs)?;
        let fits = |plan: &Plan| plan.shapes.iter().zip(inputs).all(|(shape, input)| shape == input.shape);
        match self.plans.iter().position(fits) {
            Some(index) if index + 1 == self.plans.len() => {}
            Some(index) => self.plans[index..].rotate_left(1),
            None => self.plan(inputs.iter().map(|input| input.shape.to_vec()).collect())?,
        }
        let Some(plan) = self.plans.last() else { return Err(Error::internal("a model without a plan")) };
        plan.run(&mut self.arena, inputs, &self.compute, observe)?;
        const MOST: usize = 32;
        let empty = Tensor { shape: &[], data: crate::tensor::Data::U8(&[]) };
        let mut few = [empty; MOST];
        let many;
        let output = |index| plan.output(index, &self.arena, inputs).unwrap_or(empty);
        let outputs = if plan.output_count() <= MOST {
            let few = &mut few[..plan.output_count()];
            few.iter_mut().enumerate().for_each(|(index, slot)| *slot = output(index));
            &*few
        } else {
            many = (0..plan.output_count()).map(output).collect::<Vec<_>>();
            &many
        };
        sink(outputs)
    }

    fn plan(&mut self, shapes: Vec<Vec<usize>>) -> Result<()> {
        let plan = Plan::new(&self.graph, &self.compute, shapes)?;
        if plan.arena_bytes > self.arena.bytes() {
            self.arena = Arena::new(0);
            self.arena = Arena::new(plan.arena_bytes);
        }
        if self.plans.len() >= MAX_PLANS {
            self.plans.remove(0);
        }
        self.plans.push(plan);
        Ok(())
    }

    fn check(&self, inputs: &[Tensor<'_>]) -> Result<()> {
        let declared = &self.graph.inputs;
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
            .field("inputs", &self.graph.inputs)
            .field("outputs", &self.graph.outputs)
            .finish_non_exhaustive()
    }
}
