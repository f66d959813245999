//! Control flow: branches and loops, whose graphs run on tensors.

use std::sync::Arc;

use opendr_engine::Result;
use opendr_onnx::proto::NodeProto;

use crate::attributes::Attributes;
use crate::constant::{Constant, MAX_BYTES, too_many};
use crate::graph::{Graph, Output};
use crate::tensor::Kind;

type Inputs<'a> = &'a [Option<Arc<Constant>>];

/// Runs one of the graphs of a node on its inputs, and returns its outputs.
pub(crate) type RunGraph<'a> = dyn FnMut(usize, &[Arc<Constant>]) -> Result<Vec<Arc<Constant>>> + 'a;

/// Runs an `If` or a `Loop` with these graphs.
pub(crate) fn run(
    node: &NodeProto,
    graphs: &[Arc<Graph>],
    inputs: Inputs<'_>,
    run_graph: &mut RunGraph<'_>,
) -> Result<Vec<Arc<Constant>>> {
    match (node.op_type.as_str(), graphs) {
        ("If", [_, _]) => {
            let condition = value(node, inputs, 0)?.truth(node)?;
            let captured: Vec<Arc<Constant>> =
                (1..inputs.len()).map(|slot| value(node, inputs, slot).cloned()).collect::<Result<_>>()?;
            run_graph(usize::from(!condition), &captured)
        }
        (_, [body]) => Loop::new(node, body, inputs)?.run(run_graph),
        _ => Err(node.damaged("its graph is missing")),
    }
}

fn value<'a>(node: &NodeProto, inputs: Inputs<'a>, slot: usize) -> Result<&'a Arc<Constant>> {
    let value = inputs.get(slot).and_then(Option::as_ref);
    value.ok_or_else(|| node.damaged(&format!("it has no input {slot}")))
}

/// A loop in a run.
struct Loop<'a> {
    node: &'a NodeProto,
    graph: &'a Graph,
    /// Maximum number of iterations.
    trips: Option<i64>,
    condition: bool,
    /// Values that each iteration hands to the next.
    state: Vec<Arc<Constant>>,
    /// Values of the graph around the loop.
    captured: Vec<Arc<Constant>>,
}

impl<'a> Loop<'a> {
    fn new(node: &'a NodeProto, graph: &'a Graph, inputs: Inputs<'_>) -> Result<Self> {
        let optional = |slot: usize| inputs.get(slot).and_then(Option::as_ref);
        let trips = match optional(0) {
            Some(trips) => match trips.ints().as_deref() {
                Some(&[trips]) => Some(trips),
                _ => return Err(node.damaged("its number of iterations")),
            },
            None => None,
        };
        let condition = match optional(1) {
            Some(condition) => condition.truth(node)?,
            None => true,
        };
        // The body has the inputs of the node: the iteration and the condition instead of their first values.
        let formal = graph.inputs.len();
        if formal != inputs.len() || formal < 2 {
            return Err(node.damaged("its inputs are not those of its body"));
        }
        let states = usize::try_from(node.int_or(crate::subgraphs::STATES, 0)).unwrap_or(usize::MAX);
        let values: Vec<Arc<Constant>> =
            (2..formal).map(|slot| value(node, inputs, slot).cloned()).collect::<Result<_>>()?;
        if states > values.len() || graph.outputs.len() <= states {
            return Err(node.damaged("its body returns too few values"));
        }
        let (state, captured) = values.split_at(states);
        Ok(Self { node, graph, trips, condition, state: state.to_vec(), captured: captured.to_vec() })
    }

    fn run(mut self, run_graph: &mut RunGraph<'_>) -> Result<Vec<Arc<Constant>>> {
        let states = self.state.len();
        let scanned = self.graph.outputs.len() - 1 - states;
        let mut scans: Vec<Vec<Arc<Constant>>> = vec![Vec::new(); scanned];
        let (mut iteration, mut bytes) = (0_i64, 0_usize);
        while self.condition && self.trips.is_none_or(|trips| iteration < trips) {
            let mut inputs = vec![
                Arc::new(Constant::from_ints(Vec::new(), &[iteration]).of_run()),
                Arc::new(Constant::of(Kind::Bool, Vec::new(), &[u8::from(self.condition)]).of_run()),
            ];
            inputs.append(&mut self.state);
            inputs.extend(self.captured.iter().cloned());
            let mut outputs = run_graph(0, &inputs)?.into_iter();
            let condition =
                outputs.next().ok_or_else(|| self.node.damaged("its body returns no condition"))?;
            self.condition = condition.truth(self.node)?;
            self.state.extend(outputs.by_ref().take(states));
            for (scan, value) in scans.iter_mut().zip(outputs) {
                bytes = bytes.saturating_add(value.bytes());
                scan.push(value);
            }
            // What is collected is copied once more.
            if bytes > MAX_BYTES / 2 {
                return Err(too_many(bytes));
            }
            iteration += 1;
        }
        let declared = &self.graph.outputs[1 + states..];
        let mut results = self.state;
        for (scan, declared) in scans.iter().zip(declared) {
            results.push(Arc::new(stacked(self.node, scan, declared)?.of_run()));
        }
        Ok(results)
    }
}

/// Returns the values of all iterations as one tensor.
fn stacked(node: &NodeProto, values: &[Arc<Constant>], declared: &Output) -> Result<Constant> {
    let Some(first) = values.first() else {
        let dims = declared.dims.iter().map(|dim| dim.unwrap_or(0));
        return Constant::zeros(declared.kind.unwrap_or(Kind::F32), std::iter::once(0).chain(dims).collect());
    };
    if values.iter().any(|value| value.kind != first.kind || value.shape != first.shape) {
        return Err(node.damaged("the iterations of its body return different shapes"));
    }
    let shape = [&[values.len()], first.shape.as_slice()].concat();
    let bytes: Vec<u8> = values.iter().flat_map(|value| value.numbers::<u8>()).copied().collect();
    Ok(Constant::of(first.kind, shape, &bytes))
}
