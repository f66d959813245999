//! A plan: steps with their places in the arena.

use std::sync::Arc;

use opendr_engine::{Error, Result};
use opendr_kernels::{Arena, Compute, LayerCost, Region};

use crate::constant::{Constant, Given, MAX_BYTES, too_many};
use crate::graph::Graph;
use crate::io::{Io, Kernel, Place};
use crate::memory::{lives, place};
use crate::planning::{Cut, Planned, planned};
use crate::tensor::{Data, Kind, Tensor};
use crate::value::{Id, Source};

pub(crate) struct PlannedStep {
    kernel: Box<dyn Kernel>,
    reads: Vec<Place>,
    write: Region,
    sizes: Vec<usize>,
    /// Bytes that the step writes.
    written: usize,
    pub(crate) node: usize,
}

impl PlannedStep {
    /// Returns the arithmetic and weights, and the bytes of the tensors that the step reads and writes.
    pub(crate) fn cost(&self, inputs: &[Tensor<'_>]) -> (LayerCost, u64) {
        let read: usize = self.reads.iter().map(|place| place.bytes(inputs)).sum();
        (self.kernel.cost(), (read + self.written) as u64)
    }
}

struct PlannedOutput {
    place: Place,
    kind: Kind,
    shape: Vec<usize>,
}

/// The nodes that remain after the steps of a plan.
pub(crate) struct Remaining {
    /// Names of the outputs of the plan, which the remaining nodes read.
    pub(crate) names: Vec<String>,
    /// Nodes whose outputs have shapes that depend on the elements of their inputs. They run after the steps.
    pub(crate) hosts: Vec<usize>,
    /// The stage that runs after them.
    pub(crate) stage: usize,
}

/// The steps for one shape of the inputs.
pub(crate) struct Plan {
    pub(crate) given: Vec<Given>,
    /// `None` where the steps compute the outputs of the graph.
    pub(crate) remaining: Option<Remaining>,
    steps: Vec<PlannedStep>,
    outputs: Vec<PlannedOutput>,
    pub(crate) arena_bytes: usize,
}

impl Plan {
    /// Plans the nodes of a graph that can be planned; `stage` returns the stage of those that cannot.
    pub(crate) fn new(
        graph: &Graph,
        compute: &Compute,
        given: Vec<Given>,
        stage: impl FnOnce(&Cut) -> Result<usize>,
    ) -> Result<Self> {
        let Planned { planner, outputs, cut } = planned(graph, compute, &given)?;
        let remaining = match cut {
            Some(cut) => Some(Remaining { stage: stage(&cut)?, names: cut.names, hosts: cut.hosts }),
            None => None,
        };
        let lives = lives(&planner, &outputs);
        let (starts, arena_bytes) = place(&planner.buffers, &lives);
        if arena_bytes > MAX_BYTES {
            return Err(too_many(arena_bytes));
        }
        let values = &planner.values;
        let place = |id: Id| -> Place {
            let value = &values[id];
            let bytes = value.shape.iter().product::<usize>() * value.kind.bytes();
            match &value.source {
                Source::Constant(constant) => Place::Constant(Arc::clone(constant)),
                Source::Input(index) => Place::Input(*index),
                Source::Buffer(buffer, offset) => {
                    Place::Arena(Region { start: starts[*buffer] + offset, bytes })
                }
            }
        };
        let outputs = outputs
            .iter()
            .map(|&id| PlannedOutput {
                place: place(id),
                kind: values[id].kind,
                shape: values[id].shape.clone(),
            })
            .collect();
        let mut steps = Vec::new();
        for step in planner.steps {
            if lives[step.buffer].is_none() {
                continue;
            }
            let is_unwritten =
                |id: &Id| matches!(values[*id].source, Source::Buffer(buffer, _) if lives[buffer].is_none());
            if step.reads.iter().flatten().any(is_unwritten) {
                return Err(Error::internal("a step reads what none writes"));
            }
            steps.push(PlannedStep {
                reads: step.reads.iter().map(|id| id.map_or(Place::Absent, &place)).collect(),
                write: Region { start: starts[step.buffer], bytes: planner.buffers[step.buffer] },
                kernel: step.kernel,
                sizes: step.sizes,
                written: step.written,
                node: step.node,
            });
        }
        Ok(Self { given, remaining, steps, outputs, arena_bytes })
    }

    /// Runs all steps; `observe` is called after each.
    pub(crate) fn run(
        &self,
        arena: &mut Arena,
        inputs: &[Tensor<'_>],
        compute: &Compute,
        mut observe: impl FnMut(&PlannedStep),
    ) -> Result<()> {
        for step in &self.steps {
            let (written, rest) = arena.split(step.write);
            let mut io =
                Io { reads: &step.reads, inputs, rest, written: Some(written), sizes: &step.sizes, compute };
            step.kernel.run(&mut io)?;
            observe(step);
        }
        Ok(())
    }

    /// Returns an output after a run.
    pub(crate) fn output<'a>(
        &'a self,
        index: usize,
        arena: &'a Arena,
        inputs: &[Tensor<'a>],
    ) -> Option<Tensor<'a>> {
        let output = self.outputs.get(index)?;
        let (from, region) = match &output.place {
            Place::Arena(region) => (arena, *region),
            Place::Constant(constant) => (&constant.data, constant.region()),
            Place::Input(index) => {
                return inputs.get(*index).map(|input| Tensor { shape: &output.shape, data: input.data });
            }
            Place::Absent => return None,
        };
        Some(Tensor { shape: &output.shape, data: Data::read(output.kind, from, region)? })
    }

    /// Returns an output after a run as a tensor of its own: the same one where it is an input or a constant.
    pub(crate) fn owned_output(
        &self,
        index: usize,
        arena: &Arena,
        inputs: &[Tensor<'_>],
        owned: &[Arc<Constant>],
    ) -> Option<Arc<Constant>> {
        let output = self.outputs.get(index)?;
        let same = match &output.place {
            Place::Constant(constant) => Some(constant),
            Place::Input(at) => owned.get(*at),
            _ => None,
        };
        // The same elements may have another shape here.
        if let Some(same) = same.filter(|same| same.shape == output.shape) {
            return Some(Arc::clone(same));
        }
        self.output(index, arena, inputs).map(|output| Arc::new(Constant::copied(&output)))
    }

    pub(crate) fn output_count(&self) -> usize {
        self.outputs.len()
    }
}
