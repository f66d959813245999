//! Folding of scalar factors into the following convolutions.

use std::collections::BTreeSet;

use super::rewriter::Rewriter;
use crate::array::{Array, Data, element_count};
use crate::proto::GraphProto;

/// Maximum number of operators that a factor passes; beyond it, the factor stays.
const MAX_REACH: usize = 64;

/// Folds a `Mul` by a scalar into the weights of all convolutions that its result reaches through operators that
/// commute with a factor. The `Mul` stays when it reaches any other operator.
pub fn fold_factor_into_conv(graph: &mut GraphProto) {
    let mut graph = Rewriter::new(graph);
    for index in 0..graph.node_count() {
        fold_one(&mut graph, index);
    }
    graph.finish();
}

fn fold_one(graph: &mut Rewriter, product: usize) -> Option<()> {
    let node = graph.node_of(product, "Mul")?;
    let [a, b] = node.input.as_slice() else { return None };
    let output = node.output.first()?.clone();
    let (x, factor) = match (graph.scalar(a), graph.scalar(b)) {
        (None, Some(factor)) => (a.clone(), factor),
        (Some(factor), None) => (b.clone(), factor),
        _ => return None,
    };
    let convs = reached_convs(graph, &output)?;
    let mut scaled = Vec::with_capacity(convs.len());
    let sizes =
        convs.iter().map(|&conv| element_count(&graph.constant_dims(graph.node(conv)?.input.get(1)?)?));
    let total = sizes.sum::<Option<usize>>()?;
    if !graph.can_add_constant(total) {
        return None;
    }
    for &conv in &convs {
        let weights = graph.constant(graph.node(conv)?.input.get(1)?)?;
        let values = weights.as_floats()?.iter().map(|weight| weight * factor).collect();
        scaled.push(Array::new(weights.dims().to_vec(), Data::Float(values))?);
    }
    for (conv, weights) in convs.into_iter().zip(scaled) {
        let hint = format!("{}/weights", graph.node(conv)?.output.first()?);
        let name = graph.add_constant(&hint, &weights)?;
        graph.set_input(conv, 1, &name);
    }
    graph.remove(product);
    graph.redirect(&output, &x);
    Some(())
}

/// Returns the convolutions that a factor on `tensor` reaches; `None` when it reaches an operator that does not
/// commute with it.
fn reached_convs(graph: &Rewriter, tensor: &str) -> Option<BTreeSet<usize>> {
    let mut convs = BTreeSet::new();
    let mut passed = BTreeSet::new();
    let mut tensors = vec![tensor.to_owned()];
    while let Some(tensor) = tensors.pop() {
        for &reader in graph.readers(&tensor)? {
            if passed.len() > MAX_REACH {
                return None;
            }
            let node = graph.node(reader)?;
            let slots = node.input.iter().filter(|input| **input == tensor).count();
            let first_time = slots == 1 && passed.insert(reader);
            match node.op_type.as_str() {
                "Conv" if first_time && node.input.first() == Some(&tensor) => {
                    convs.insert(reader);
                }
                "GlobalAveragePool" | "Mul" if first_time => tensors.push(node.output.first()?.clone()),
                _ => return None,
            }
        }
    }
    (!convs.is_empty()).then_some(convs)
}
