//! Planning of a graph for one shape of its inputs: values with known shapes, and the steps that compute them.

use std::cell::{Cell, RefCell};
use std::collections::{HashMap, HashSet};
use std::sync::Arc;

use opendr_engine::{Error, Result};
use opendr_kernels::{ALIGNMENT, Arena, Compute, Region};
use opendr_onnx::proto::NodeProto;

use crate::attributes::Attributes;
use crate::constant::{Constant, Given, MAX_BYTES, too_many};
use crate::graph::{Graph, Packed};
use crate::io::{Io, Kernel, Place};
use crate::remap;
use crate::tensor::{Kind, count};
pub(crate) use crate::value::{Id, Layout, Source, Value};

pub(crate) struct Step {
    pub(crate) kernel: Box<dyn Kernel>,
    pub(crate) reads: Vec<Option<Id>>,
    pub(crate) buffer: usize,
    pub(crate) sizes: Vec<usize>,
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
    branching: Option<usize>,
    /// Bytes of the constants that planning has computed.
    computed: usize,
    /// Whether the node has read a constant that another plan may not have.
    varying: Cell<bool>,
    /// Values that the node needs and no plan knows before a run.
    missing: RefCell<Vec<Id>>,
}

/// Bytes of a constant that planning may compute, and of all of them.
const MAX_CONSTANT: usize = 1 << 28;
const MAX_CONSTANTS: usize = 1 << 31;

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

    /// Gives a name to a value, unless it has one.
    pub(crate) fn name(&mut self, name: &str, id: Id) {
        self.names.entry(name.to_owned()).or_insert(id);
    }

    fn add(&mut self, kind: Kind, shape: Vec<usize>, layout: Layout, source: Source) -> Id {
        self.values.push(Value { kind, shape, layout, source, other: None });
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

    /// Adds a step, or computes it where it depends on constants only. Outputs are given by type, shape and layout.
    pub(crate) fn emit(
        &mut self,
        kernel: impl Kernel + 'static,
        reads: &[Option<Id>],
        outputs: &[(Kind, Vec<usize>, Layout)],
    ) -> Result<Vec<Id>> {
        let sizes = outputs
            .iter()
            .map(|(kind, shape, _)| Ok(count(shape)? * kind.bytes()))
            .collect::<Result<Vec<usize>>>()?;
        let offsets: Vec<usize> = sizes
            .iter()
            .scan(0, |offset, size| {
                let at = *offset;
                *offset += size.next_multiple_of(ALIGNMENT);
                Some(at)
            })
            .collect();
        let bytes = sizes.iter().map(|size| size.next_multiple_of(ALIGNMENT)).sum();
        let known = reads.iter().flatten().all(|&id| matches!(self.values[id].source, Source::Constant(_)));
        if known && outputs.len() == 1 {
            return self.evaluate(&kernel, reads, &outputs[0], &sizes);
        }
        let buffer = self.buffers.len();
        self.buffers.push(bytes);
        self.steps.push(Step {
            kernel: Box::new(kernel),
            reads: reads.to_vec(),
            buffer,
            sizes,
            node: self.branching.unwrap_or(self.node),
        });
        let mut ids = Vec::new();
        for ((kind, shape, layout), offset) in outputs.iter().zip(offsets) {
            ids.push(self.add(*kind, shape.clone(), *layout, Source::Buffer(buffer, offset)));
        }
        Ok(ids)
    }

    fn evaluate(
        &mut self,
        kernel: &dyn Kernel,
        reads: &[Option<Id>],
        (kind, shape, layout): &(Kind, Vec<usize>, Layout),
        sizes: &[usize],
    ) -> Result<Vec<Id>> {
        let bytes = sizes[0];
        self.computed = self.computed.saturating_add(bytes);
        if bytes > MAX_CONSTANT || self.computed > MAX_CONSTANTS {
            return Err(Error::unsupported(format!("the ONNX model computes a constant of {bytes} bytes")));
        }
        let mut varies = self.varying.get();
        let reads: Vec<Place> = reads
            .iter()
            .map(|id| match id.map(|id| &self.values[id].source) {
                Some(Source::Constant(constant)) => {
                    varies |= constant.varies;
                    Place::Constant(Arc::clone(constant))
                }
                _ => Place::Absent,
            })
            .collect();
        let mut data = Arena::new(bytes);
        let (written, rest) = data.split(Region { start: 0, bytes });
        kernel.run(&mut Io {
            reads: &reads,
            inputs: &[],
            rest,
            written: Some(written),
            sizes,
            compute: self.compute,
        })?;
        let constant = Arc::new(Constant { kind: *kind, shape: shape.clone(), data, varies });
        let id = self.add(*kind, shape.clone(), *layout, Source::Constant(constant));
        Ok(vec![id])
    }

    /// Adds a step with one output.
    pub(crate) fn emit_one(
        &mut self,
        kernel: impl Kernel + 'static,
        reads: &[Id],
        kind: Kind,
        shape: Vec<usize>,
        layout: Layout,
    ) -> Result<Id> {
        let reads: Vec<Option<Id>> = reads.iter().copied().map(Some).collect();
        let ids = self.emit(kernel, &reads, &[(kind, shape, layout)])?;
        ids.first().copied().ok_or_else(|| Error::internal("a step without an output"))
    }

    /// Returns the same elements, in the same order of memory, with another shape.
    pub(crate) fn alias(&mut self, id: Id, shape: Vec<usize>, layout: Layout) -> Id {
        let value = self.values[id].clone();
        let source = match value.source {
            Source::Constant(constant) if layout == Layout::Plain => {
                let (kind, varies) = (constant.kind, constant.varies);
                let data = copy(&constant);
                Source::Constant(Arc::new(Constant { kind, shape: shape.clone(), data, varies }))
            }
            other => other,
        };
        self.add(value.kind, shape, layout, source)
    }

    /// Returns a part of a value that a step writes, from a byte on.
    pub(crate) fn view(&mut self, id: Id, bytes: usize, shape: Vec<usize>) -> Option<Id> {
        let value = self.values[id].clone();
        let Source::Buffer(buffer, offset) = value.source else { return None };
        Some(self.add(value.kind, shape, Layout::Plain, Source::Buffer(buffer, offset + bytes)))
    }

    /// Returns the value in the order of its shape.
    pub(crate) fn plain(&mut self, id: Id) -> Result<Id> {
        self.relaid(id, Layout::Plain)
    }

    /// Returns the value with channels last; only of rank 3 or more.
    pub(crate) fn channels_last(&mut self, id: Id) -> Result<Id> {
        self.relaid(id, Layout::ChannelsLast)
    }

    fn relaid(&mut self, id: Id, layout: Layout) -> Result<Id> {
        let value = self.values[id].clone();
        if value.layout == layout {
            return Ok(id);
        }
        if let Some(other) = value.other {
            return Ok(other);
        }
        let rank = value.shape.len();
        let pixels: usize = value.shape.iter().skip(2).product();
        let same = rank < 3 || value.shape[1] == 1 || pixels == 1;
        let other = if same {
            self.alias(id, value.shape.clone(), layout)
        } else {
            // Dimensions of the result in the order of memory, by those of the source.
            let mut order: Vec<usize> = (0..rank).collect();
            match layout {
                Layout::ChannelsLast => order[1..].rotate_left(1),
                Layout::Plain => order[1..].rotate_right(1),
            }
            let remap = remap::transposed(&value.physical(), &order, value.kind.bytes());
            self.emit_one(remap, &[id], value.kind, value.shape.clone(), layout)?
        };
        self.values[id].other = Some(other);
        self.values[other].other = Some(id);
        Ok(other)
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

fn copy(constant: &Constant) -> Arena {
    Arena::from_numbers(constant.data.get::<u8>(constant.region()))
}
