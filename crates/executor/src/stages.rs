//! The stages of a graph: each runs what can be planned when it begins.
//!
//! Most graphs have one. Where the shape of a tensor depends on the elements of a run (`NonZero`, a branch, a loop, sizes that are
//! computed), the plan ends there; what remains is a graph of its own, planned when these elements are known.

use std::collections::HashMap;
use std::sync::Arc;

use opendr_engine::{Error, Result};
use opendr_kernels::{Arena, Compute};
use opendr_onnx::proto::NodeProto;

use crate::constant::{Constant, Given, MAX_BYTES, too_many};
use crate::control;
use crate::graph::Graph;
use crate::ops::{self, Operator};
use crate::plan::Plan;
use crate::planning::Cut;
use crate::run::Run;
use crate::tensor::Tensor;

/// Plans for different shapes that a stage keeps.
const MAX_PLANS: usize = 8;

/// Maximum number of stages of a graph.
const MAX_STAGES: usize = 1 << 10;

/// Receives the outputs of a graph.
pub(crate) type Outputs<'a> = dyn FnMut(&[Tensor<'_>]) -> Result<()> + 'a;

/// A graph with the plans of its stages.
pub(crate) struct Stages {
    /// The first one has the whole graph.
    stages: Vec<Stage>,
    /// The graphs within nodes, by the index of the node's graphs.
    bodies: HashMap<usize, Vec<Stages>>,
}

struct Stage {
    graph: Arc<Graph>,
    /// The plan that was used last comes last.
    plans: Vec<Plan>,
    /// The stages that follow, with the nodes and by-value tensors that determine them.
    following: Vec<(Following, usize)>,
}

/// What determines a following stage.
#[derive(PartialEq)]
struct Following {
    nodes: Vec<usize>,
    by_value: Vec<String>,
}

impl Stage {
    fn new(graph: Arc<Graph>) -> Self {
        Self { graph, plans: Vec::new(), following: Vec::new() }
    }
}

impl Stages {
    pub(crate) fn new(graph: Arc<Graph>) -> Self {
        Self { stages: vec![Stage::new(graph)], bodies: HashMap::new() }
    }

    /// Returns whether the first stage has a plan.
    pub(crate) fn is_planned(&self) -> bool {
        self.stages.first().is_some_and(|stage| !stage.plans.is_empty())
    }

    /// Plans the first stage for these inputs.
    pub(crate) fn prepare(&mut self, compute: &Compute, arena: &mut Arena, given: Vec<Given>) -> Result<()> {
        let plan = self.plan(0, compute, given)?;
        reserve(arena, &plan);
        self.keep(0, plan);
        Ok(())
    }

    /// Runs the graph on its inputs, and calls `sink` with its outputs.
    pub(crate) fn run(
        &mut self,
        run: &mut Run<'_>,
        inputs: &[Tensor<'_>],
        sink: &mut Outputs<'_>,
    ) -> Result<()> {
        let mut values = self.run_stage(0, run, inputs, &[], sink)?;
        let mut at = 0;
        while let Some(named) = values.take() {
            at = self.following(at)?;
            let stage = self.stages.get(at).ok_or_else(|| Error::internal("a stage that is not there"))?;
            let find = |name: &String| {
                let value = named.get(name).cloned();
                value.ok_or_else(|| {
                    Error::format(format!("damaged ONNX model: nothing produces the value {name:?}"))
                })
            };
            let owned = stage.graph.inputs.iter().map(find).collect::<Result<Vec<_>>>()?;
            drop(named);
            let bytes = owned.iter().map(|value| value.bytes()).fold(0_usize, usize::saturating_add);
            if bytes > MAX_BYTES {
                return Err(too_many(bytes));
            }
            // Tensors that plans know are not read in a run.
            let tensors: Vec<Tensor<'_>> =
                owned.iter().map(|value| value.tensor().unwrap_or(Tensor::EMPTY)).collect();
            values = self.run_stage(at, run, &tensors, &owned, sink)?;
        }
        Ok(())
    }

    /// Returns the stage after the one that has just run.
    fn following(&self, at: usize) -> Result<usize> {
        let plan = self.stages.get(at).and_then(|stage| stage.plans.last());
        let remaining = plan.and_then(|plan| plan.remaining.as_ref());
        remaining.map(|remaining| remaining.stage).ok_or_else(|| Error::internal("a stage without a plan"))
    }

    /// Runs a stage. Returns the tensors that the next stage reads, by name; `None` where this was the last and `sink` has the
    /// outputs.
    fn run_stage(
        &mut self,
        at: usize,
        run: &mut Run<'_>,
        inputs: &[Tensor<'_>],
        owned: &[Arc<Constant>],
        sink: &mut Outputs<'_>,
    ) -> Result<Option<HashMap<String, Arc<Constant>>>> {
        self.select(at, run, inputs, owned)?;
        let Stage { graph, plans, .. } = &self.stages[at];
        let Some(plan) = plans.last() else { return Err(Error::internal("a model without a plan")) };
        let observe = &mut *run.observe;
        plan.run(run.arena, inputs, run.compute, |step| {
            if let Some(node) = graph.nodes.get(step.node) {
                observe(node, &|| step.cost(inputs));
            }
        })?;
        let Some(remaining) = &plan.remaining else {
            give(plan, run.arena, inputs, sink)?;
            return Ok(None);
        };
        let mut values = HashMap::new();
        for (index, name) in remaining.names.iter().enumerate() {
            let value = plan.owned_output(index, run.arena, inputs, owned);
            let value = value
                .ok_or_else(|| Error::unsupported(format!("{name:?} of the ONNX model has 16-bit floats")))?;
            values.insert(name.clone(), value);
        }
        let (graph, hosts) = (Arc::clone(graph), remaining.hosts.clone());
        for node in hosts.iter().filter_map(|&index| graph.nodes.get(index)) {
            let outputs = self.run_host(&graph, node, run, &values)?;
            (run.observe)(node, &Default::default);
            values.extend(node.output.iter().cloned().zip(outputs));
        }
        Ok(Some(values))
    }

    /// Runs a node on tensors.
    fn run_host(
        &mut self,
        graph: &Graph,
        node: &NodeProto,
        run: &mut Run<'_>,
        values: &HashMap<String, Arc<Constant>>,
    ) -> Result<Vec<Arc<Constant>>> {
        let inputs: Vec<Option<Arc<Constant>>> =
            node.input.iter().map(|name| values.get(name).cloned()).collect();
        if let Some(Operator::Host(host)) = ops::operator(&node.op_type) {
            let inputs: Vec<Option<&Constant>> = inputs.iter().map(Option::as_deref).collect();
            return Ok(host(node, &inputs)?.into_iter().map(|output| Arc::new(output.of_run())).collect());
        }
        let (key, graphs) = crate::subgraphs::bodies(graph, node)?;
        let mut bodies = self
            .bodies
            .remove(&key)
            .unwrap_or_else(|| graphs.iter().map(|graph| Self::new(Arc::clone(graph))).collect());
        let outputs = control::run(node, graphs, &inputs, &mut |graph, inputs| {
            let body = bodies.get_mut(graph).ok_or_else(|| Error::internal("a graph that is not there"))?;
            body.run_within(run, inputs)
        });
        self.bodies.insert(key, bodies);
        outputs
    }

    /// Runs a graph within a node, without the observer of the graph around it.
    fn run_within(&mut self, run: &mut Run<'_>, inputs: &[Arc<Constant>]) -> Result<Vec<Arc<Constant>>> {
        run.count_iteration()?;
        let tensors = inputs.iter().map(|input| {
            let tensor = input.tensor();
            tensor.ok_or_else(|| Error::unsupported("16-bit floats in a branch or a loop of the ONNX model"))
        });
        let tensors = tensors.collect::<Result<Vec<Tensor<'_>>>>()?;
        let mut inner =
            Run { arena: &mut *run.arena, compute: run.compute, looped: run.looped, observe: &mut |_, _| () };
        let mut outputs = Vec::new();
        let ran = self.run(&mut inner, &tensors, &mut |tensors| {
            outputs.extend(tensors.iter().map(|tensor| Arc::new(Constant::copied(tensor))));
            Ok(())
        });
        run.looped = inner.looped;
        ran.map(|()| outputs)
    }

    /// Makes the plan for these inputs the last one of its stage.
    fn select(
        &mut self,
        at: usize,
        run: &mut Run<'_>,
        inputs: &[Tensor<'_>],
        owned: &[Arc<Constant>],
    ) -> Result<()> {
        let stage = self.stages.get_mut(at).ok_or_else(|| Error::internal("a stage that is not there"))?;
        let by_value = &stage.graph.by_value;
        let value = |index: usize| owned.get(index).filter(|_| by_value.get(index) == Some(&true));
        let fits = |plan: &Plan| {
            let pairs = plan.given.iter().zip(inputs).enumerate();
            pairs.into_iter().all(|(index, (given, input))| given.fits(input, value(index)))
        };
        match stage.plans.iter().position(fits) {
            Some(index) if index + 1 == stage.plans.len() => {}
            Some(index) => stage.plans[index..].rotate_left(1),
            None => {
                let given = inputs.iter().enumerate().map(|(index, input)| match value(index) {
                    Some(value) => Given::value(value),
                    None => Given { kind: input.data.kind(), shape: input.shape.to_vec(), value: None },
                });
                let given = given.collect();
                let plan = self.plan(at, run.compute, given)?;
                reserve(run.arena, &plan);
                self.keep(at, plan);
                return Ok(());
            }
        }
        // A body of the loop around this one may have a larger plan; the arena is shared and never shrinks.
        if let Some(plan) = self.stages[at].plans.last() {
            reserve(run.arena, plan);
        }
        Ok(())
    }

    fn plan(&mut self, at: usize, compute: &Compute, given: Vec<Given>) -> Result<Plan> {
        let graph = Arc::clone(&self.stages[at].graph);
        let stages = &mut self.stages;
        Plan::new(&graph, compute, given, |cut| following(stages, at, cut))
    }

    fn keep(&mut self, at: usize, plan: Plan) {
        let Some(Stage { plans, .. }) = self.stages.get_mut(at) else { return };
        if plans.len() >= MAX_PLANS {
            plans.remove(0);
        }
        plans.push(plan);
    }
}

/// Returns the stage of what remains after a cut of stage `at`; adds it where it is new.
fn following(stages: &mut Vec<Stage>, at: usize, cut: &Cut) -> Result<usize> {
    let mut by_value: Vec<String> = cut.by_value.iter().cloned().collect();
    by_value.sort_unstable();
    let key = Following { nodes: cut.later.clone(), by_value };
    if let Some((_, stage)) = stages[at].following.iter().find(|(other, _)| *other == key) {
        return Ok(*stage);
    }
    if stages.len() >= MAX_STAGES {
        return Err(Error::unsupported(format!("the ONNX model needs more than {MAX_STAGES} stages")));
    }
    let graph = stages[at].graph.rest(&cut.later, &cut.by_value)?;
    stages.push(Stage::new(Arc::new(graph)));
    let index = stages.len() - 1;
    stages[at].following.push((key, index));
    Ok(index)
}

/// Makes the arena as large as a plan needs.
fn reserve(arena: &mut Arena, plan: &Plan) {
    if plan.arena_bytes > arena.bytes() {
        *arena = Arena::new(0);
        *arena = Arena::new(plan.arena_bytes);
    }
}

/// Calls `sink` with the outputs of a plan that has run.
fn give(plan: &Plan, arena: &Arena, inputs: &[Tensor<'_>], sink: &mut Outputs<'_>) -> Result<()> {
    const MOST: usize = 32;
    let mut few = [Tensor::EMPTY; MOST];
    let many;
    let output = |index| plan.output(index, arena, inputs).unwrap_or(Tensor::EMPTY);
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
