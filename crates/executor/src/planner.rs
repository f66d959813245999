//! Planning of a graph for one shape of its inputs: values with known shapes, and the steps that compute them.

use std::cell::{Cell, RefCell};
use std::collections::{HashMap, HashSet};
use std::sync::Arc;

use opendr_engine::Result;
use opendr_kernels::Compute;
use opendr_onnx::proto::NodeProto;

use crate::attributes::Attributes;
use crate::constant::{Constant, Given, MAX_BYTES, too_many};
use crate::graph::{Graph, Packed};
use crate::io::Kernel;
use crate::tensor::{Kind, count};
pub(crate) use crate::value::{Id, Layout, Source, Value};

pub(crate) struct Step {
    pub(crate) kernel: Box<dyn Kernel>,
    pub(crate) reads: Vec<Option<Id>>,
    pub(crate) buffer: usize,
    pub(crate) sizes: Vec<usize>,
    /// Bytes that the step writes.
    pub(crate) written: usize,
    /// Index of the node.
    pub(crate) node: usize,
}

pub(crate) struct Planner<'a> {
    pub(crate) graph: &'a Graph,
    pub(crate) compute: &'a Compute,
    pub(crate) values: Vec<Value>,
    pub(crate) steps: Vec<Step>,
    /// Bytes of each buffer.
    pub(crate) buffers: Vec<usize>,
    names: HashMap<String, Id>,
    fused: HashSet<usize>,
    /// Dequantised values that nothing has read as floats yet, and their nodes.
    deferred: HashMap<String, usize>,
    pub(crate) node: usize,
    /// The node of the planned graph whose branch is planned, if one is.
    pub(crate) branching: Option<usize>,
    /// Bytes of the constants that planning has computed.
    pub(crate) computed: usize,
    /// Whether the node has read a constant that another plan may not have.
    pub(crate) varying: Cell<bool>,
    /// Values that the node needs and no plan knows before a run.
    missing: RefCell<Vec<Id>>,
}

impl<'a> Planner<'a> {
    /// Begins with the constants and inputs of a graph.
    pub(crate) fn new(graph: &'a Graph, compute: &'a Compute, given: &[Given]) -> Result<Self> {
        let mut planner = Self {
            graph,
            compute,
            values: Vec::new(),
            steps: Vec::new(),
            buffers: Vec::new(),
            names: HashMap::new(),
            fused: HashSet::new(),
            deferred: HashMap::new(),
            node: 0,
            branching: None,
            computed: 0,
            varying: Cell::new(false),
            missing: RefCell::default(),
        };
        planner.add_constants();
        for (index, (name, Given { kind, shape, value })) in graph.inputs.iter().zip(given).enumerate() {
            let bytes = count(shape)?.saturating_mul(kind.bytes());
            if bytes > MAX_BYTES {
                return Err(too_many(bytes));
            }
            let id = match value {
                Some(constant) => planner.add_constant_of(Arc::clone(constant)),
                None => planner.add(*kind, shape.clone(), Layout::Plain, Source::Input(index)),
            };
            planner.names.insert(name.clone(), id);
        }
        Ok(planner)
    }

    fn add_constants(&mut self) {
        for (name, constant) in &self.graph.constants {
            let id = self.add_constant_of(Arc::clone(constant));
            self.names.insert(name.clone(), id);
        }
    }

    /// Plans a branch of the node as a part of this plan: `inputs` are the values that the branch reads.
    pub(crate) fn within<R>(
        &mut self,
        branch: &'a Graph,
        inputs: &[Option<Id>],
        plan: impl FnOnce(&mut Self) -> Result<R>,
    ) -> Result<R> {
        let (node, branching) = (self.node, self.branching);
        let graph = std::mem::replace(&mut self.graph, branch);
        let (names, fused) = (std::mem::take(&mut self.names), std::mem::take(&mut self.fused));
        let deferred = std::mem::take(&mut self.deferred);
        self.branching = branching.or(Some(node));
        self.add_constants();
        let known = branch.inputs.iter().zip(inputs).filter_map(|(name, id)| Some((name.clone(), (*id)?)));
        self.names.extend(known);
        let planned = plan(self);
        (self.graph, self.names, self.fused, self.deferred) = (graph, names, fused, deferred);
        (self.node, self.branching) = (node, branching);
        planned
    }

    /// Begins with the steps of a node.
    pub(crate) fn begin(&mut self, node: usize) {
        self.node = node;
        self.varying.set(false);
        self.missing.borrow_mut().clear();
    }

    /// Returns the values without which the node cannot be planned, and forgets them.
    pub(crate) fn take_missing(&self) -> Vec<Id> {
        self.missing.take()
    }

    /// Returns packed weights, which all plans of the graph share where they cannot differ.
    pub(crate) fn packed(&self, variant: u8, make: impl FnOnce() -> Packed) -> Packed {
        if self.varying.get() { make() } else { self.graph.packed((self.node, variant), make) }
    }

    /// Returns the index of the step that computes a value with channels last, if only this node reads the value.
    pub(crate) fn only_step(&self, id: Id) -> Option<usize> {
        let value = &self.values[id];
        let Source::Buffer(buffer, 0) = value.source else { return None };
        if self.branching.is_some() || value.layout != Layout::ChannelsLast {
            return None;
        }
        let mut writers = (0..self.steps.len()).filter(|&step| self.steps[step].buffer == buffer);
        let writer = writers.next().filter(|_| writers.next().is_none())?;
        let is_of_buffer =
            |id: Id| matches!(self.values[id].source, Source::Buffer(other, _) if other == buffer);
        if self.steps[writer..].iter().flat_map(|step| &step.reads).flatten().any(|&id| is_of_buffer(id)) {
            return None;
        }
        let is_own = |reader: &usize| *reader == self.node || self.is_fused(*reader);
        let mut names = self.names.iter().filter(|(_, id)| is_of_buffer(**id));
        let is_only_here = names.all(|(name, _)| {
            self.graph.readers.get(name).is_none_or(|readers| {
                readers.iter().all(is_own)
                    && readers.iter().filter(|&&reader| reader == self.node).count() <= 1
            })
        });
        is_only_here.then_some(writer)
    }

    /// Gives a name to a value, unless it has one.
    pub(crate) fn name(&mut self, name: &str, id: Id) {
        self.names.entry(name.to_owned()).or_insert(id);
    }

    pub(crate) fn add(&mut self, kind: Kind, shape: Vec<usize>, layout: Layout, source: Source) -> Id {
        self.values.push(Value { kind, shape, layout, source, other: None, reshaped: None });
        self.values.len() - 1
    }

    pub(crate) fn add_constant(&mut self, mut constant: Constant) -> Id {
        constant.varies |= self.varying.get();
        self.add_constant_of(Arc::new(constant))
    }

    /// Adds a constant that depends on the shapes of this plan.
    pub(crate) fn add_size(&mut self, constant: Constant) -> Id {
        self.add_constant_of(Arc::new(Constant { varies: true, ..constant }))
    }

    fn add_constant_of(&mut self, constant: Arc<Constant>) -> Id {
        self.add(constant.kind, constant.shape.clone(), Layout::Plain, Source::Constant(constant))
    }

    pub(crate) fn value(&self, id: Id) -> &Value {
        &self.values[id]
    }

    pub(crate) fn shape(&self, id: Id) -> Vec<usize> {
        self.values[id].shape.clone()
    }

    pub(crate) fn kind(&self, id: Id) -> Kind {
        self.values[id].kind
    }

    pub(crate) fn rank(&self, id: Id) -> usize {
        self.values[id].shape.len()
    }

    pub(crate) fn is_channels_last(&self, id: Id) -> bool {
        self.values[id].layout == Layout::ChannelsLast
    }

    /// Returns the constant of a value in the order of its shape.
    pub(crate) fn constant(&self, id: Id) -> Option<Arc<Constant>> {
        let value = &self.values[id];
        let constant = match (&value.source, value.layout, value.other) {
            (Source::Constant(constant), Layout::Plain, _) => Some(constant),
            (Source::Constant(_), Layout::ChannelsLast, Some(other)) => match &self.values[other].source {
                Source::Constant(constant) => Some(constant),
                _ => None,
            },
            _ => None,
        }?;
        self.varying.set(self.varying.get() || constant.varies);
        Some(Arc::clone(constant))
    }

    /// Returns the constant of a value that the plan depends on.
    ///
    /// # Errors
    /// `Unsupported` where a run computes the value: the node is then planned in the run.
    pub(crate) fn known(&self, node: &NodeProto, id: Id) -> Result<Arc<Constant>> {
        self.constant(id).ok_or_else(|| {
            self.missing.borrow_mut().push(id);
            node.refused("a value that depends on the data of the inputs")
        })
    }

    /// Returns whether the value is known before a run.
    pub(crate) fn is_constant(&self, id: Id) -> bool {
        matches!(self.values[id].source, Source::Constant(_))
    }

    /// Returns the number of a constant of one float.
    pub(crate) fn scalar(&self, id: Id) -> Option<f32> {
        let constant = self.constant(id)?;
        match constant.floats()? {
            [value] => Some(*value),
            _ => None,
        }
    }

    /// Returns a constant list of integers.
    ///
    /// # Errors
    /// Those of [`Planner::known`], and `Format` where it does not have integers.
    pub(crate) fn ints(&self, node: &NodeProto, id: Id) -> Result<Vec<i64>> {
        let list = self.known(node, id)?.ints();
        list.ok_or_else(|| node.damaged("a shape or list does not have integers"))
    }

    /// Returns the value that a name has got so far.
    pub(crate) fn named(&self, name: &str) -> Option<Id> {
        self.names.get(name).copied()
    }

    /// Defers a node that dequantises, until a node reads its output as floats. Returns `false` where an input of it is
    /// deferred itself.
    pub(crate) fn defer(&mut self, node: usize) -> bool {
        let inputs = &self.graph.nodes[node].input;
        if inputs.iter().any(|input| self.deferred.contains_key(input)) {
            return false;
        }
        let Some(output) = self.graph.nodes[node].output.first() else { return false };
        self.deferred.insert(output.clone(), node);
        true
    }

    /// Returns the node that dequantises a value, if it is deferred.
    pub(crate) fn deferred(&self, name: &str) -> Option<&'a NodeProto> {
        self.deferred.get(name).map(|&node| &self.graph.nodes[node])
    }

    /// Returns the deferred node of a value, and forgets it.
    pub(crate) fn take_deferred(&mut self, name: &str) -> Option<usize> {
        self.deferred.remove(name)
    }

    /// States that a node needs no step of its own: `id` is its output.
    pub(crate) fn absorb(&mut self, node: usize, id: Option<Id>) {
        self.fused.insert(node);
        if let (Some(id), Some(name)) = (id, self.graph.nodes[node].output.first()) {
            self.names.insert(name.clone(), id);
        }
    }

    pub(crate) fn is_fused(&self, node: usize) -> bool {
        self.fused.contains(&node)
    }
}
