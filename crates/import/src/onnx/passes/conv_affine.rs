//! Folds multiplications and additions per channel into the convolution before them.

use super::rewriter::Rewriter;
use crate::onnx::array::{Array, Data};
use crate::onnx::proto::GraphProto;

/// What follows a convolution: `y * scale + shift`, per output channel.
struct Affine {
    scale: Vec<f32>,
    shift: Vec<f32>,
}

/// Folds `Add`, `Sub`, `Mul`, `Div` with a constant per channel, and `BatchNormalization`, into the weights and bias
/// of the `Conv` before them.
pub fn fold_affine_into_conv(graph: &mut GraphProto) {
    let mut graph = Rewriter::new(graph);
    for index in 0..graph.node_count() {
        fold_one(&mut graph, index);
    }
    graph.finish();
}

fn fold_one(graph: &mut Rewriter, conv: usize) -> Option<()> {
    let node = graph.node_of(conv, "Conv")?;
    let weights = graph.constant(node.input.get(1)?)?;
    let filters = *weights.dims().first()?;
    let bias = match node.input.get(2).filter(|name| !name.is_empty()) {
        Some(name) => graph.constant(name)?.as_floats()?.to_vec(),
        None => vec![0.0; filters],
    };
    if bias.len() != filters {
        return None;
    }
    let rank = weights.dims().len();
    let mut affine = Affine { scale: vec![1.0; filters], shift: bias };
    let mut folded = false;
    while let Some(reader) =
        following(graph, conv).filter(|&reader| affine.follow(graph, conv, reader, rank).is_some())
    {
        graph.absorb(conv, reader);
        folded = true;
    }
    if !folded {
        return None;
    }
    let block = weights.data().len().checked_div(filters)?;
    let scaled = weights.as_floats()?.chunks(block.max(1)).zip(&affine.scale);
    let scaled = scaled.flat_map(|(filter, scale)| filter.iter().map(move |weight| weight * scale)).collect();
    let output = graph.node(conv)?.output.first()?.clone();
    let weights = Array::new(weights.dims().to_vec(), Data::Float(scaled))?;
    let weights = graph.add_constant(&format!("{output}/weights"), &weights)?;
    let bias = graph
        .add_constant(&format!("{output}/bias"), &Array::new(vec![filters], Data::Float(affine.shift))?)?;
    graph.set_input(conv, 1, &weights);
    graph.set_input(conv, 2, &bias);
    Some(())
}

fn following(graph: &Rewriter, conv: usize) -> Option<usize> {
    graph.only_reader(graph.node(conv)?.output.first()?)
}

impl Affine {
    /// Takes in what `reader` does to the output of `conv`; `None`, with nothing taken in, if that is not affine.
    fn follow(&mut self, graph: &Rewriter, conv: usize, reader: usize, rank: usize) -> Option<()> {
        let output = graph.node(conv)?.output.first()?;
        let node = graph.node(reader)?;
        if node.output.len() != 1 {
            return None;
        }
        if node.op_type == "BatchNormalization" && node.input.first() == Some(output) {
            return self.normalise(graph, reader);
        }
        let (x, y) = (node.input.first()?, node.input.get(1)?);
        let other = if x == output { y } else { x };
        let other = self.per_channel(&graph.constant(other)?, rank)?;
        let pairs = self.scale.iter_mut().zip(&mut self.shift).zip(other);
        match (node.op_type.as_str(), x == output) {
            ("Add", _) => pairs.for_each(|((_, shift), other)| *shift += other),
            ("Sub", true) => pairs.for_each(|((_, shift), other)| *shift -= other),
            ("Mul", _) => {
                pairs.for_each(|((scale, shift), other)| (*scale, *shift) = (*scale * other, *shift * other))
            }
            ("Div", true) => {
                pairs.for_each(|((scale, shift), other)| (*scale, *shift) = (*scale / other, *shift / other));
            }
            _ => return None,
        }
        Some(())
    }

    fn normalise(&mut self, graph: &Rewriter, reader: usize) -> Option<()> {
        let node = graph.node(reader)?;
        let epsilon = node.find("epsilon").map_or(1e-5, |attribute| attribute.f);
        let vector = |slot: usize| {
            let array = graph.constant(node.input.get(slot)?)?;
            (array.dims() == [self.scale.len()]).then(|| array.as_floats().map(<[f32]>::to_vec))?
        };
        let (gamma, beta, mean, variance) = (vector(1)?, vector(2)?, vector(3)?, vector(4)?);
        for (channel, (scale, shift)) in self.scale.iter_mut().zip(&mut self.shift).enumerate() {
            let factor = gamma[channel] / (variance[channel] + epsilon).sqrt();
            *scale *= factor;
            *shift = (*shift - mean[channel]) * factor + beta[channel];
        }
        Some(())
    }

    /// One float per channel from a constant that broadcasts along the channel axis only.
    fn per_channel(&self, array: &Array, rank: usize) -> Option<Vec<f32>> {
        let values = array.as_floats()?;
        let dims = array.dims();
        let channels = self.scale.len();
        if values.len() == 1 && dims.len() <= rank {
            return Some(vec![values[0]; channels]);
        }
        let missing = rank.checked_sub(dims.len())?;
        let along_channels = (0..dims.len()).all(|axis| match axis + missing {
            1 => dims[axis] == channels,
            _ => dims[axis] == 1,
        });
        (along_channels && values.len() == channels).then(|| values.to_vec())
    }
}
