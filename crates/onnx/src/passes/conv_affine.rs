//! Folding of per-channel scales and shifts into the preceding convolution.

use super::rewriter::Rewriter;
use crate::array::{Array, Data, element_count};
use crate::proto::{GraphProto, NodeProto};

/// The operation after a convolution: `y * scale + shift`, per output channel.
struct Affine {
    scale: Vec<f32>,
    shift: Vec<f32>,
}

/// Folds `Add`, `Sub`, `Mul`, `Div` with a constant per channel, and `BatchNormalization`, into the weights and bias
/// of the `Conv` or `ConvTranspose` before them.
pub fn fold_affine_into_conv(graph: &mut GraphProto) {
    let mut graph = Rewriter::new(graph);
    for index in 0..graph.node_count() {
        fold_one(&mut graph, index);
    }
    graph.finish();
}

fn fold_one(graph: &mut Rewriter, conv: usize) -> Option<()> {
    let node = graph.node_of(conv, "Conv").or_else(|| graph.node_of(conv, "ConvTranspose"))?;
    let (weights, bias) =
        (node.input.get(1)?.clone(), node.input.get(2).filter(|name| !name.is_empty()).cloned());
    let dims = graph.constant_dims(&weights)?;
    let layout = Layout::from_node(node, &dims)?;
    let (rank, filters) = (dims.len(), layout.filters);
    let affordable = graph.can_add_constant(element_count(&dims)?.checked_add(filters)?);
    following(graph, conv).filter(|_| affordable)?;
    let shift = match bias {
        Some(name) => vector(graph, &name, filters)?,
        None => vec![0.0; filters],
    };
    let mut affine = Affine { scale: vec![1.0; filters], shift };
    let mut reader = following(graph, conv)?;
    affine.follow(graph, conv, reader, rank)?;
    let weights = graph.constant(&weights).filter(|weights| weights.as_floats().is_some())?;
    loop {
        graph.absorb(conv, reader);
        match following(graph, conv) {
            Some(next) if affine.follow(graph, conv, next, rank).is_some() => reader = next,
            _ => break,
        }
    }
    let blocks = weights.as_floats()?.chunks(layout.block.max(1)).enumerate();
    let scaled = blocks.flat_map(|(block, weights)| {
        let scale = affine.scale[layout.filter_of(block)];
        weights.iter().map(move |weight| weight * scale)
    });
    let scaled = scaled.collect();
    let output = graph.node(conv)?.output.first()?.clone();
    let weights = Array::new(weights.dims().to_vec(), Data::Float(scaled))?;
    let weights = graph.add_constant(&format!("{output}/weights"), &weights)?;
    let bias = graph
        .add_constant(&format!("{output}/bias"), &Array::new(vec![filters], Data::Float(affine.shift))?)?;
    graph.set_input(conv, 1, &weights);
    graph.set_input(conv, 2, &bias);
    Some(())
}

/// Layout of the weights: `[filters, inputs / groups, ..]`, or `[inputs, filters / groups, ..]` for a transposed
/// convolution.
struct Layout {
    filters: usize,
    /// Number of contiguous weights of one filter.
    block: usize,
    /// Filters and inputs per group of a transposed convolution.
    group: Option<[usize; 2]>,
}

impl Layout {
    fn from_node(node: &NodeProto, dims: &[usize]) -> Option<Self> {
        let [first, second, kernel @ ..] = dims else { return None };
        if node.op_type == "Conv" {
            return Some(Self {
                filters: *first,
                block: element_count(dims)?.checked_div(*first)?,
                group: None,
            });
        }
        let groups = usize::try_from(node.int_or("group", 1)).ok()?;
        let inputs = first.checked_div(groups).filter(|inputs| *inputs > 0 && first % groups == 0)?;
        let group = Some([*second, inputs]).filter(|_| *second > 0);
        Some(Self {
            filters: second.checked_mul(groups)?,
            block: element_count(kernel)?,
            group: Some(group?),
        })
    }

    fn filter_of(&self, block: usize) -> usize {
        match self.group {
            None => block,
            Some([filters, inputs]) => block / filters / inputs * filters + block % filters,
        }
    }
}

fn following(graph: &Rewriter, conv: usize) -> Option<usize> {
    graph.only_reader(graph.node(conv)?.output.first()?)
}

impl Affine {
    /// Applies the operation of `reader` on the output of `conv`; `None`, without any change, if it is not affine.
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
        let other = self.per_channel(graph, other, rank)?;
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
        let channels = self.scale.len();
        let epsilon = node.find("epsilon").map_or(1e-5, |attribute| attribute.f);
        let parameter = |slot: usize| vector(graph, node.input.get(slot)?, channels);
        let (gamma, beta, mean, variance) = (parameter(1)?, parameter(2)?, parameter(3)?, parameter(4)?);
        for (channel, (scale, shift)) in self.scale.iter_mut().zip(&mut self.shift).enumerate() {
            let factor = gamma[channel] / (variance[channel] + epsilon).sqrt();
            *scale *= factor;
            *shift = (*shift - mean[channel]) * factor + beta[channel];
        }
        Some(())
    }

    /// Returns one float per channel from a constant that broadcasts along the channel axis only.
    fn per_channel(&self, graph: &Rewriter, name: &str, rank: usize) -> Option<Vec<f32>> {
        let channels = self.scale.len();
        if let Some(value) = graph.scalar(name) {
            let deeper = graph.constant_dims(name)?.len() > rank;
            return (!deeper).then(|| vec![value; channels]);
        }
        let dims = graph.constant_dims(name)?;
        let missing = rank.checked_sub(dims.len())?;
        let along_channels = (0..dims.len()).all(|axis| match axis + missing {
            1 => dims[axis] == channels,
            _ => dims[axis] == 1,
        });
        let values = graph.constant(name).filter(|_| along_channels)?;
        values.as_floats().filter(|values| values.len() == channels).map(<[f32]>::to_vec)
    }
}

/// Returns a constant list of `length` floats.
fn vector(graph: &Rewriter, name: &str, length: usize) -> Option<Vec<f32>> {
    (graph.constant_dims(name)? == [length]).then(|| graph.constant(name))??.as_floats().map(<[f32]>::to_vec)
}
