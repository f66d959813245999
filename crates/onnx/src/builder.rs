//! Construction of a graph node by node, with constant folding and common-subexpression elimination.

use std::collections::{BTreeMap, HashMap};

use opendr_engine::{Error, Result};
use prost::Message;

use super::array::{Array, ElementType};
use super::fold;
use super::graph_tensor::{Dim, GraphTensor};
use super::operator::Operator;
use super::proto::{
    Dimension, DimensionValue, GraphProto, NodeProto, TensorProto, TensorShapeProto, TensorType, TypeProto,
    TypeValue, ValueInfoProto,
};

/// Maximum number of nodes. Real models have far fewer; a hostile one could need a node per element of a huge axis.
const MAX_NODES: usize = 100_000;

/// Maximum number of elements that constant folding may produce over the whole graph; beyond it, nodes are written.
const MAX_FOLDED: usize = 1 << 26;

/// Maximum size of constants that are compared by content, so that equal shapes share one initializer.
const SMALL: usize = 16;

/// A graph under construction.
#[derive(Default)]
pub struct Builder {
    nodes: Vec<NodeProto>,
    initializers: Vec<TensorProto>,
    inputs: Vec<ValueInfoProto>,
    outputs: Vec<ValueInfoProto>,
    names: BTreeMap<String, usize>,
    written: HashMap<Vec<u8>, Vec<GraphTensor>>,
    small_constants: HashMap<Vec<u8>, String>,
    large_constants: HashMap<usize, (String, GraphTensor)>,
    folded: usize,
}

impl Builder {
    /// Adds an input of the graph. `open` has names of its open dimensions; an empty or missing name leaves a
    /// dimension unnamed.
    pub fn input(&mut self, name: &str, kind: ElementType, dims: Vec<Dim>, open: &[&str]) -> GraphTensor {
        let name = self.unique(name);
        self.inputs.push(value_info(&name, kind, &dims, open));
        GraphTensor::new(&name, kind, dims, None)
    }

    /// Declares an output with the name `name`. A tensor that already has a name (an input, a constant, another
    /// output) is passed through an `Identity`. `open` has names of its open dimensions, as in [`Builder::input`].
    ///
    /// # Errors
    /// `Format` when the graph exceeds the maximum number of nodes.
    pub fn output(&mut self, name: &str, wire: &GraphTensor, doc: &str, open: &[&str]) -> Result<()> {
        let source = self.source_name(wire)?;
        let mut node = Operator::new("Identity").into_node(name);
        node.input.push(source);
        node.output.push(name.to_owned());
        self.push(node)?;
        let mut info = value_info(name, wire.kind(), wire.dims(), open);
        info.doc_string = doc.to_owned();
        self.outputs.push(info);
        Ok(())
    }

    /// Adds an operator with one output, or evaluates it.
    ///
    /// # Errors
    /// `Format` when the graph exceeds the maximum number of nodes.
    pub fn add(
        &mut self,
        hint: &str,
        operator: Operator,
        inputs: &[&GraphTensor],
        kind: ElementType,
        dims: Vec<Dim>,
    ) -> Result<GraphTensor> {
        let outputs = self.add_many(hint, operator, inputs, vec![(kind, dims)])?;
        outputs.into_iter().next().ok_or_else(|| Error::internal("operator without output"))
    }

    /// Adds an operator with several outputs, or evaluates it.
    ///
    /// # Errors
    /// `Format` when the graph exceeds the maximum number of nodes.
    pub fn add_many(
        &mut self,
        hint: &str,
        operator: Operator,
        inputs: &[&GraphTensor],
        outputs: Vec<(ElementType, Vec<Dim>)>,
    ) -> Result<Vec<GraphTensor>> {
        let known = self.evaluate(&operator, inputs).filter(|known| known.len() == outputs.len());
        if let Some(known) = &known
            && known.iter().all(Array::is_complete)
        {
            return Ok(known.iter().cloned().map(GraphTensor::constant).collect());
        }
        let mut node = operator.into_node("");
        for input in inputs {
            node.input.push(self.source_name(input)?);
        }
        let key = node.encode_to_vec();
        if let Some(outputs) = self.written.get(&key) {
            return Ok(outputs.clone());
        }
        let mut known = known.unwrap_or_default().into_iter();
        let mut wires = Vec::with_capacity(outputs.len());
        for (kind, dims) in outputs {
            let name = self.unique(hint);
            node.output.push(name.clone());
            wires.push(GraphTensor::new(&name, kind, dims, known.next()));
        }
        node.name = node.output.first().cloned().unwrap_or_default();
        self.push(node)?;
        self.written.insert(key, wires.clone());
        Ok(wires)
    }

    fn push(&mut self, node: NodeProto) -> Result<()> {
        if self.nodes.len() >= MAX_NODES {
            return Err(Error::format(format!(
                "the graph needs more than {MAX_NODES} nodes; the model is damaged or hostile"
            )));
        }
        self.nodes.push(node);
        Ok(())
    }

    fn evaluate(&mut self, operator: &Operator, inputs: &[&GraphTensor]) -> Option<Vec<Array>> {
        let known = match operator.name() {
            "Shape" => {
                let dims = inputs.first()?.dims();
                vec![Array::partial(
                    dims.iter().map(|dim| dim.and_then(|dim| i64::try_from(dim).ok())).collect(),
                )]
            }
            "Size" => vec![Array::int(i64::try_from(inputs.first()?.element_count()?).ok()?)],
            _ => {
                let unknown = |wire: &&GraphTensor| !wire.name.is_empty() && wire.known().is_none();
                if self.folded > MAX_FOLDED || inputs.iter().any(unknown) {
                    return None;
                }
                fold::evaluate(operator, &inputs.iter().map(|wire| wire.known()).collect::<Vec<_>>())?
            }
        };
        self.folded += known.iter().map(|array| array.data().len()).sum::<usize>();
        Some(known)
    }

    /// Returns the name by which a node refers to `wire`; writes an initializer for a constant.
    fn source_name(&mut self, wire: &GraphTensor) -> Result<String> {
        let Some(array) = wire.array() else { return Ok(wire.name.to_string()) };
        let hint = if wire.name.is_empty() { "constant" } else { &*wire.name };
        if array.data().len() <= SMALL {
            let key = array.to_tensor("")?.encode_to_vec();
            if let Some(name) = self.small_constants.get(&key) {
                return Ok(name.clone());
            }
            let name = self.unique(hint);
            self.initializers.push(array.to_tensor(&name)?);
            self.small_constants.insert(key, name.clone());
            return Ok(name);
        }
        if let Some((name, _)) = self.large_constants.get(&wire.address()) {
            return Ok(name.clone());
        }
        let name = self.unique(hint);
        self.initializers.push(array.to_tensor(&name)?);
        self.large_constants.insert(wire.address(), (name.clone(), wire.clone()));
        Ok(name)
    }

    /// Returns `hint`, or `hint_2`, `hint_3` where it is used.
    fn unique(&mut self, hint: &str) -> String {
        let hint = if hint.is_empty() { "tensor" } else { hint };
        let mut name = hint.to_owned();
        while self.names.contains_key(&name) {
            let count = self.names.entry(hint.to_owned()).or_insert(1);
            *count += 1;
            name = format!("{hint}_{count}");
        }
        self.names.insert(name.clone(), 1);
        name
    }

    /// Reserves a name for an output.
    pub fn reserve(&mut self, name: &str) {
        self.names.insert(name.to_owned(), 1);
    }

    /// Returns the finished graph.
    pub fn finish(self, name: &str) -> GraphProto {
        GraphProto {
            name: name.to_owned(),
            node: self.nodes,
            initializer: self.initializers,
            input: self.inputs,
            output: self.outputs,
            ..GraphProto::default()
        }
    }
}

fn value_info(name: &str, kind: ElementType, dims: &[Dim], open: &[&str]) -> ValueInfoProto {
    let dimension = |(axis, dim): (usize, &Dim)| {
        let value = match (dim, open.get(axis)) {
            (Some(dim), _) => Some(DimensionValue::Value(*dim as i64)),
            (None, Some(name)) if !name.is_empty() => Some(DimensionValue::Param((*name).to_owned())),
            (None, _) => None,
        };
        Dimension { value, ..Dimension::default() }
    };
    let shape = TensorShapeProto { dim: dims.iter().enumerate().map(dimension).collect() };
    let tensor = TensorType { elem_type: kind.data_type() as i32, shape: Some(shape) };
    ValueInfoProto {
        name: name.to_owned(),
        r#type: Some(TypeProto { value: Some(TypeValue::Tensor(tensor)), ..TypeProto::default() }),
        ..ValueInfoProto::default()
    }
}
