//! Fusion of the operators of MobileNetV3's activation.

use super::rewriter::Rewriter;
use crate::array::Array;
use crate::proto::GraphProto;

/// Rewrites `(x * c) * clip(x + 3, 0, 6)` as `HardSwish(x) * 6c`, and `x * HardSigmoid(x)` as `HardSwish(x)`. The
/// factor differs from 1 only where `c` was rounded to half precision;
/// [`fold_factor_into_conv`](super::fold_factor_into_conv) folds it further.
pub fn fuse_hard_swish(graph: &mut GraphProto) {
    let mut graph = Rewriter::new(graph);
    for index in 0..graph.node_count() {
        if fuse_sigmoid(&mut graph, index).is_none() {
            fuse_one(&mut graph, index);
        }
    }
    graph.finish();
}

/// Fuses `x * HardSigmoid(x)`, with slope 1/6 and offset 1/2.
fn fuse_sigmoid(graph: &mut Rewriter, product: usize) -> Option<()> {
    let node = graph.node_of(product, "Mul")?;
    let [a, b] = node.input.as_slice() else { return None };
    let (x, sigmoid) = match graph.producer(b, "HardSigmoid") {
        Some(sigmoid) => (a.clone(), sigmoid),
        None => (b.clone(), graph.producer(a, "HardSigmoid")?),
    };
    let node = graph.node(sigmoid)?;
    let number = |key: &str| node.find(key).map(|attribute| attribute.f);
    let as_swish = number("beta")? == 0.5 && (number("alpha")? - 1.0 / 6.0).abs() < 1e-6;
    if !as_swish || *node.input.first()? != x || only_output_reader(graph, sigmoid) != Some(product) {
        return None;
    }
    graph.remove(sigmoid);
    graph.replace(product, "HardSwish", &[x]);
    Some(())
}

fn fuse_one(graph: &mut Rewriter, product: usize) -> Option<()> {
    let node = graph.node_of(product, "Mul")?;
    let [a, b] = node.input.as_slice() else { return None };
    let (scaled, clipped) = match graph.producer(b, "Clip") {
        Some(_) => (a, b),
        None => (b, a),
    };
    let (scaled, clip) = (graph.producer(scaled, "Mul")?, graph.producer(clipped, "Clip")?);
    let [shifted, low, high] = graph.node(clip)?.input.as_slice() else { return None };
    let shift = graph.producer(shifted, "Add")?;
    let (x, factor) = with_scalar(graph, scaled)?;
    let (same, offset) = with_scalar(graph, shift)?;
    let bounds = (graph.scalar(low)?, graph.scalar(high)?);
    let only_here = only_output_reader(graph, scaled) == Some(product)
        && only_output_reader(graph, clip) == Some(product)
        && only_output_reader(graph, shift) == Some(clip);
    if x != same || offset != 3.0 || bounds != (0.0, 6.0) || !only_here {
        return None;
    }
    let swish = graph.node(scaled)?.output.first()?.clone();
    let factor = graph.add_constant(&format!("{swish}/factor"), &Array::scalar(6.0 * factor))?;
    graph.remove(clip);
    graph.remove(shift);
    graph.replace(scaled, "HardSwish", &[x]);
    graph.replace(product, "Mul", &[swish, factor]);
    Some(())
}

/// Returns the operand and the scalar of an operator with one constant of one element.
fn with_scalar(graph: &Rewriter, index: usize) -> Option<(String, f32)> {
    let [a, b] = graph.node(index)?.input.as_slice() else { return None };
    match (graph.scalar(a), graph.scalar(b)) {
        (None, Some(value)) => Some((a.clone(), value)),
        (Some(value), None) => Some((b.clone(), value)),
        _ => None,
    }
}

fn only_output_reader(graph: &Rewriter, index: usize) -> Option<usize> {
    graph.only_reader(graph.node(index)?.output.first()?)
}
