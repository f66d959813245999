//! A plan: steps with their places in the arena.

use std::collections::BTreeMap;
use std::sync::Arc;

use opendr_engine::{Error, Result};
use opendr_kernels::{ALIGNMENT, Arena, Compute, Region};

use crate::graph::Graph;
use crate::io::{Io, Kernel, Place};
use crate::ops;
use crate::planner::{Id, Planner, Source};
use crate::tensor::{Data, Kind, Tensor};

/// Bytes of the arena beyond which a model is refused.
const MAX_ARENA: usize = 1 << 32;

/// Bytes behind the last tensor.
const SLACK: usize = 256;

struct PlannedStep {
    kernel: Box<dyn Kernel>,
    reads: Vec<Place>,
    write: Region,
    sizes: Vec<usize>,
    node: usize,
}

struct PlannedOutput {
    place: Place,
    kind: Kind,
    shape: Vec<usize>,
}

/// The steps for one shape of the inputs.
pub(crate) struct Plan {
    pub(crate) shapes: Vec<Vec<usize>>,
    steps: Vec<PlannedStep>,
    outputs: Vec<PlannedOutput>,
    pub(crate) arena_bytes: usize,
}

impl Plan {
    pub(crate) fn new(graph: &Graph, compute: &Compute, shapes: Vec<Vec<usize>>) -> Result<Self> {
        let (planner, outputs) = planned(graph, compute, &shapes)?;
        let lives = lives(&planner, &outputs);
        let (starts, arena_bytes) = place(&planner.buffers, &lives);
        if arena_bytes > MAX_ARENA {
            return Err(Error::unsupported(format!(
                "the ONNX model needs {arena_bytes} bytes for its tensors"
            )));
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
            steps.push(PlannedStep {
                reads: step.reads.iter().map(|id| id.map_or(Place::Absent, &place)).collect(),
                write: Region { start: starts[step.buffer], bytes: planner.buffers[step.buffer] },
                kernel: step.kernel,
                sizes: step.sizes,
                node: step.node,
            });
        }
        Ok(Self { shapes, steps, outputs, arena_bytes })
    }

    /// Runs all steps; `observe` is called after each with the index of its node.
    pub(crate) fn run(
        &self,
        arena: &mut Arena,
        inputs: &[Tensor<'_>],
        compute: &Compute,
        mut observe: impl FnMut(usize),
    ) -> Result<()> {
        for step in &self.steps {
            let (written, rest) = arena.split(step.write);
            let mut io =
                Io { reads: &step.reads, inputs, rest, written: Some(written), sizes: &step.sizes, compute };
            step.kernel.run(&mut io)?;
            observe(step.node);
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
        let data = match output.kind {
            Kind::F32 => Data::F32(from.get(region)),
            Kind::I64 => Data::I64(from.get(region)),
            Kind::I32 => Data::I32(from.get(region)),
            Kind::U8 => Data::U8(from.get(region)),
            Kind::I8 => Data::I8(from.get(region)),
            Kind::Bool => Data::Bool(from.get(region)),
            Kind::F16 => return None,
        };
        Some(Tensor { shape: &output.shape, data })
    }

    pub(crate) fn output_count(&self) -> usize {
        self.outputs.len()
    }
}

/// Builds the steps of all nodes; returns them with the outputs of the graph.
fn planned<'a>(
    graph: &'a Graph,
    compute: &'a Compute,
    shapes: &[Vec<usize>],
) -> Result<(Planner<'a>, Vec<Id>)> {
    let mut planner = Planner::new(graph, compute, shapes)?;
    for (index, node) in graph.nodes.iter().enumerate() {
        if planner.is_fused(index) {
            continue;
        }
        planner.node = index;
        if node.op_type == "DequantizeLinear" && planner.defer(index) {
            continue;
        }
        let outputs = match ops::build_on_bytes(&mut planner, node)? {
            Some(outputs) => outputs,
            None => build(&mut planner, index)?,
        };
        for (name, id) in node.output.iter().zip(outputs) {
            planner.name(name, id);
        }
    }
    let mut outputs = Vec::new();
    for output in &graph.outputs {
        materialise(&mut planner, &output.name)?;
        let id = planner.named(&output.name).ok_or_else(|| {
            Error::format(format!("damaged ONNX model: nothing produces the output {:?}", output.name))
        })?;
        if planner.kind(id) != output.kind {
            return Err(Error::format(format!(
                "damaged ONNX model: the output {:?} is declared as {:?}, but is {:?}",
                output.name,
                output.kind,
                planner.kind(id)
            )));
        }
        outputs.push(planner.plain(id)?);
    }
    Ok((planner, outputs))
}

/// Builds the steps of a node whose inputs are read as they are.
fn build(planner: &mut Planner<'_>, index: usize) -> Result<Vec<Id>> {
    let node = &planner.graph.nodes[index];
    for name in &node.input {
        materialise(planner, name)?;
    }
    planner.node = index;
    let inputs: Vec<Option<Id>> = node.input.iter().map(|name| planner.named(name)).collect();
    ops::build(planner, node, &inputs)
}

/// Dequantises a value that has been deferred.
fn materialise(planner: &mut Planner<'_>, name: &str) -> Result<()> {
    let Some(index) = planner.take_deferred(name) else { return Ok(()) };
    planner.node = index;
    let node = &planner.graph.nodes[index];
    // The inputs of a deferred node are not deferred.
    let inputs: Vec<Option<Id>> = node.input.iter().map(|name| planner.named(name)).collect();
    for (name, id) in node.output.iter().zip(ops::build(planner, node, &inputs)?) {
        planner.name(name, id);
    }
    Ok(())
}

/// Returns the first and last step of every buffer; `None` where nothing needs it.
fn lives(planner: &Planner<'_>, outputs: &[Id]) -> Vec<Option<[usize; 2]>> {
    let buffer = |id: Id| match planner.values[id].source {
        Source::Buffer(buffer, _) => Some(buffer),
        _ => None,
    };
    let mut last: Vec<Option<usize>> = vec![None; planner.buffers.len()];
    for id in outputs.iter().filter_map(|&id| buffer(id)) {
        last[id] = Some(planner.steps.len());
    }
    let mut lives = vec![None; planner.buffers.len()];
    for (index, step) in planner.steps.iter().enumerate().rev() {
        let Some(end) = last[step.buffer] else { continue };
        lives[step.buffer] = Some([index, end]);
        for read in step.reads.iter().flatten().filter_map(|&id| buffer(id)) {
            last[read] = Some(last[read].map_or(index, |last| last.max(index)));
        }
    }
    lives
}

/// Places buffers so that those that live at the same time do not overlap: the largest first, each at the lowest
/// free offset.
fn place(sizes: &[usize], lives: &[Option<[usize; 2]>]) -> (Vec<usize>, usize) {
    let mut order: Vec<usize> = (0..sizes.len()).filter(|&buffer| lives[buffer].is_some()).collect();
    order.sort_by_key(|&buffer| std::cmp::Reverse(sizes[buffer]));
    let mut starts = vec![0; sizes.len()];
    let mut placed: Vec<usize> = Vec::new();
    let mut total = 0;
    for buffer in order {
        let Some([first, last]) = lives[buffer] else { continue };
        let mut taken: BTreeMap<usize, usize> = BTreeMap::new();
        for &other in &placed {
            if lives[other].is_some_and(|[from, to]| from <= last && first <= to) {
                let end = taken.entry(starts[other]).or_default();
                *end = (*end).max(starts[other] + sizes[other]);
            }
        }
        let mut at = 0;
        for (start, end) in taken {
            if at + sizes[buffer] <= start {
                break;
            }
            at = at.max(end.next_multiple_of(ALIGNMENT));
        }
        starts[buffer] = at;
        total = total.max(at + sizes[buffer]);
        placed.push(buffer);
    }
    (starts, total + SLACK)
}
