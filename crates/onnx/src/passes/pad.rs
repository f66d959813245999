//! Folding of `Pad` nodes into convolutions (zeros) and maximum pooling (lowest number).

use super::rewriter::Rewriter;
use crate::proto::GraphProto;

/// Folds a `Pad` of height and width into every `Conv` (zeros) or `MaxPool` (lowest number) that reads it.
pub fn fold_padding(graph: &mut GraphProto) {
    let mut graph = Rewriter::new(graph);
    for index in 0..graph.node_count() {
        for op in ["Conv", "MaxPool"] {
            fold_one(&mut graph, index, op);
        }
    }
    graph.finish();
}

fn fold_one(graph: &mut Rewriter, reader: usize, op: &str) -> Option<()> {
    let node = graph.node_of(reader, op)?;
    if node.find("auto_pad").is_some_and(|attribute| attribute.s != b"NOTSET") {
        return None;
    }
    let kernel = node.ints("kernel_shape")?.to_vec();
    let own = node.ints("pads").map_or_else(|| vec![0; 2 * kernel.len()], <[i64]>::to_vec);
    let pad = graph.node(graph.producer(node.input.first()?, "Pad")?)?;
    let source = pad.input.first()?.clone();
    let outer = outer_pads(graph, pad, op)?;
    if outer.len() != own.len() || own.iter().any(|&pad| pad < 0) {
        return None;
    }
    let sum: Vec<i64> = own.iter().zip(&outer).map(|(own, outer)| own + outer).collect();
    let (before, after) = sum.split_at(kernel.len());
    if op == "MaxPool"
        && kernel.iter().zip(before.iter().zip(after)).any(|(kernel, (a, b))| a >= kernel || b >= kernel)
    {
        return None;
    }
    graph.node_mut(reader)?.set_ints("pads", sum);
    graph.set_input(reader, 0, &source);
    Some(())
}

/// Returns the padding of height and width, if no other axis is padded and the value is neutral for `op`.
fn outer_pads(graph: &Rewriter, pad: &crate::proto::NodeProto, op: &str) -> Option<Vec<i64>> {
    if pad.find("mode").is_some_and(|mode| mode.s != b"constant") || pad.input.len() > 3 {
        return None;
    }
    let value = match pad.input.get(2).filter(|name| !name.is_empty()) {
        Some(name) => graph.scalar(name)?,
        None => 0.0,
    };
    let ignored = if op == "Conv" { value == 0.0 } else { value <= f32::MIN };
    let name = pad.input.get(1).filter(|name| graph.constant_dims(name).is_some_and(|dims| dims == [8]))?;
    let pads = graph.constant(name)?;
    let pads = pads.as_ints()?;
    let (before, after) = pads.split_at_checked(pads.len() / 2)?;
    let (outer_before, before) = before.split_at_checked(2)?;
    let (outer_after, after) = after.split_at_checked(2)?;
    let spatial = outer_before == [0, 0] && outer_after == [0, 0];
    let small = pads.iter().all(|pad| (0..=1 << 24).contains(pad));
    (ignored && spatial && small).then(|| [before, after].concat())
}
