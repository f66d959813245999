//! What follows a convolution or product and is computed with it: activation, slopes per channel, and a sum.

use opendr_kernels::Unary;
use opendr_onnx::proto::NodeProto;

use super::elementwise::{clip_of, unary_of};
use crate::constant::Constant;
use crate::planner::{Id, Planner};
use crate::tensor::Kind;

/// The nodes that are computed with another one.
#[derive(Debug, Default)]
pub(crate) struct Fused {
    /// Numbers that are added first, one per channel.
    pub(crate) bias: Option<Vec<f32>>,
    pub(crate) activation: Unary,
    pub(crate) slopes: Option<Vec<f32>>,
    pub(crate) residual: Option<Id>,
    pub(crate) residual_last: bool,
    nodes: Vec<usize>,
}

impl Fused {
    /// States that `y` is the output of the last fused node.
    pub(crate) fn absorb(&self, planner: &mut Planner<'_>, y: Id) {
        for (index, &node) in self.nodes.iter().enumerate() {
            let last = index + 1 == self.nodes.len();
            planner.absorb(node, last.then_some(y));
        }
    }
}

/// What can be computed with a node.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Fusible {
    /// Axis of the channels.
    pub(crate) axis: usize,
    /// Whether the node adds a bias: it has none of its own.
    pub(crate) bias: bool,
    /// Whether the node adds a tensor of the shape of its output.
    pub(crate) sum: bool,
}

/// Returns what can be computed with `node`, whose first output has the given shape.
pub(crate) fn after(planner: &Planner<'_>, node: &NodeProto, shape: &[usize], fusible: Fusible) -> Fused {
    let mut fused = Fused::default();
    let Some(mut name) = node.output.first().cloned() else { return fused };
    let mut acts = false;
    loop {
        if !acts && let Some((function, nodes)) = swish(planner, &name) {
            fused.activation = function;
            acts = true;
            let Some(next) = nodes.last().and_then(|&last| output(planner, last)) else { break };
            fused.nodes.extend(nodes);
            name = next;
            continue;
        }
        let Some(index) = planner.graph.only_reader(&name).filter(|&index| !planner.is_fused(index)) else {
            break;
        };
        let next = &planner.graph.nodes[index];
        if next.output.len() != 1 {
            break;
        }
        if !acts && next.input.first() == Some(&name) {
            let inputs: Vec<Option<Id>> = next.input.iter().map(|name| planner.named(name)).collect();
            let others_known =
                next.input.iter().zip(&inputs).skip(1).all(|(name, id)| name.is_empty() || id.is_some());
            let function = match next.op_type.as_str() {
                "Clip" if others_known => clip_of(planner, next, &inputs),
                "Max" | "Min" => bounded(planner, next, &inputs),
                "PRelu" => {
                    fused.slopes = slopes(planner, &inputs, shape, fusible.axis);
                    fused.slopes.is_some().then_some(Unary::Identity)
                }
                _ => unary_of(next),
            };
            if let Some(function) = function {
                fused.activation = function;
                acts = true;
                fused.nodes.push(index);
                name.clone_from(&next.output[0]);
                continue;
            }
        }
        if next.op_type == "Add" && next.input.len() == 2 && fused.residual.is_none() {
            let other = if next.input[0] == name { &next.input[1] } else { &next.input[0] };
            if fusible.bias && !acts && fused.bias.is_none() {
                let constant = planner.named(other).and_then(|other| planner.constant(other));
                fused.bias = constant.and_then(|constant| per_channel(&constant, shape, fusible.axis));
                if fused.bias.is_some() {
                    fused.nodes.push(index);
                    name.clone_from(&next.output[0]);
                    continue;
                }
            }
            if !fusible.sum {
                break;
            }
            let fits =
                |id: &Id| planner.shape(*id) == shape && planner.kind(*id) == Kind::F32 && *other != name;
            if let Some(residual) = planner.named(other).filter(fits) {
                fused.residual = Some(residual);
                fused.residual_last = acts;
                fused.nodes.push(index);
                name.clone_from(&next.output[0]);
                if acts {
                    break;
                }
                continue;
            }
        }
        break;
    }
    fused
}

fn output(planner: &Planner<'_>, node: usize) -> Option<String> {
    planner.graph.nodes.get(node)?.output.first().cloned()
}

/// Returns the functions `x * sigmoid(x)` and `x * hard_sigmoid(x)`, and their nodes.
fn swish(planner: &Planner<'_>, name: &str) -> Option<(Unary, Vec<usize>)> {
    let [first, second] = planner.graph.readers.get(name)?.as_slice() else { return None };
    let (gate, product) =
        if planner.graph.nodes.get(*first)?.op_type == "Mul" { (*second, *first) } else { (*first, *second) };
    let (gate_node, product_node) = (planner.graph.nodes.get(gate)?, planner.graph.nodes.get(product)?);
    let gated = gate_node.output.first()?;
    let function = match (gate_node.op_type.as_str(), unary_of(gate_node)?) {
        ("Sigmoid", _) => Unary::Swish,
        ("HardSigmoid", Unary::HardSigmoid { alpha, beta })
            if (alpha - 1.0 / 6.0).abs() < 1e-6 && beta == 0.5 =>
        {
            Unary::HardSwish
        }
        _ => return None,
    };
    let whole = product_node.op_type == "Mul"
        && product_node.input.len() == 2
        && product_node.input.contains(gated)
        && product_node.input.iter().any(|input| input == name)
        && planner.graph.only_reader(gated) == Some(product);
    whole.then_some((function, vec![gate, product]))
}

/// Returns `Max` or `Min` with a constant as a clip.
fn bounded(planner: &Planner<'_>, node: &NodeProto, inputs: &[Option<Id>]) -> Option<Unary> {
    let [_, Some(bound)] = inputs else { return None };
    let bound = planner.scalar(*bound)?;
    if planner.rank(inputs[1]?) > 1 {
        return None;
    }
    Some(match node.op_type.as_str() {
        "Max" => Unary::Clip { low: bound, high: f32::INFINITY },
        _ => Unary::Clip { low: f32::NEG_INFINITY, high: bound },
    })
}

/// Returns one slope per channel.
fn slopes(planner: &Planner<'_>, inputs: &[Option<Id>], shape: &[usize], axis: usize) -> Option<Vec<f32>> {
    let constant = planner.constant(inputs.get(1).copied().flatten()?)?;
    match constant.floats()? {
        [slope] => Some(vec![*slope; *shape.get(axis)?]),
        _ => per_channel(&constant, shape, axis),
    }
}

/// Returns a constant that broadcasts to one number per channel.
fn per_channel(constant: &Constant, shape: &[usize], axis: usize) -> Option<Vec<f32>> {
    let (values, channels) = (constant.floats()?, *shape.get(axis)?);
    let missing = shape.len().checked_sub(constant.shape.len())?;
    let along = constant
        .shape
        .iter()
        .enumerate()
        .all(|(d, &dim)| if d + missing == axis { dim == channels } else { dim == 1 });
    (along && values.len() == channels).then(|| values.to_vec())
}
