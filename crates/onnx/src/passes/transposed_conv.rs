//! Rewriting of transposed convolutions as convolutions.

use std::collections::HashMap;

use super::split::{Split, split_nodes};
use crate::array::{Array, Data};
use crate::operator::Operator;
use crate::proto::{GraphProto, NodeProto};

/// Rewrites 2D `ConvTranspose` with one group and constant weights as `Conv`. With a stride of `s`, each of the
/// `s * s` phases of the result uses every `s`-th weight; one convolution computes all phases as channels,
/// `DepthToSpace` interleaves them, and `Slice` removes the padding. ONNX Runtime's own `ConvTranspose` is several
/// times as slow on CPUs. Returns whether any node was rewritten. Needs opset 11 or later.
pub fn transposed_conv_to_conv(graph: &mut GraphProto) -> bool {
    let transposed = transposed_in(graph);
    if transposed.is_empty() {
        return false;
    }
    split_nodes(graph, |index, node| transposed.get(&index)?.split(node))
}

/// A transposed convolution that can be rewritten.
struct Transposed {
    /// Inputs, outputs, height, width of the weights.
    dims: [usize; 4],
    weights: Vec<f32>,
    bias: Option<Vec<f32>>,
    stride: usize,
    /// Rows and columns to cut from the full result at the top, left, bottom, right.
    cut: [usize; 4],
}

/// Returns the transposed convolutions of a graph that can be rewritten, by node index.
fn transposed_in(graph: &GraphProto) -> HashMap<usize, Transposed> {
    let is_transposed = |node: &NodeProto| {
        node.op_type == "ConvTranspose" && node.domain.is_empty() && node.output.len() == 1
    };
    let places = || graph.node.iter().enumerate().filter(|(_, node)| is_transposed(node));
    if places().next().is_none() {
        return HashMap::new();
    }
    let constants: HashMap<&str, _> =
        graph.initializer.iter().map(|tensor| (tensor.name.as_str(), tensor)).collect();
    let floats = |name: &str| {
        let array = Array::from_tensor(constants.get(name)?)?;
        Some((array.dims().to_vec(), array.as_floats()?.to_vec()))
    };
    let transposed = |node: &NodeProto| {
        let (dims, weights) = floats(node.input.get(1)?)?;
        let dims: [usize; 4] = dims.try_into().ok()?;
        let bias = match node.input.get(2).map(String::as_str) {
            None | Some("") => None,
            Some(name) => Some(floats(name)?.1),
        };
        Transposed::new(node, dims, weights, bias)
    };
    places().filter_map(|(index, node)| Some((index, transposed(node)?))).collect()
}

impl Transposed {
    fn new(
        node: &NodeProto,
        dims @ [_, outputs, height, width]: [usize; 4],
        weights: Vec<f32>,
        bias: Option<Vec<f32>>,
    ) -> Option<Self> {
        let pair = |key: &str, usual: i64| match node.ints(key) {
            None => Some([usual; 2]),
            Some(&[y, x]) => Some([y, x]),
            Some(_) => None,
        };
        let pads = node.ints("pads").map_or(Some([0; 4]), |pads| pads.try_into().ok())?;
        let kernel = [height, width].map(|side| i64::try_from(side).unwrap_or(i64::MAX));
        let [stride, other] = pair("strides", 1)?;
        let is_plain = node.int_or("group", 1) == 1
            && pair("dilations", 1)? == [1; 2]
            && node.find("kernel_shape").is_none_or(|_| node.ints("kernel_shape") == Some(&kernel))
            && node.find("output_shape").is_none()
            && node.find("auto_pad").is_none_or(|pad| pad.s == b"NOTSET")
            && (1..=16).contains(&stride)
            && stride == other
            && dims.iter().all(|dim| (1..1 << 20).contains(dim))
            && pads.iter().all(|pad| (0..1 << 20).contains(pad))
            && bias.as_ref().is_none_or(|bias| bias.len() == outputs);
        if !is_plain {
            return None;
        }
        let extra = pair("output_padding", 0)?;
        let end = |axis: usize| {
            let whole = (kernel[axis] + stride - 1) / stride * stride;
            whole.checked_sub(kernel[axis])?.checked_add(pads[axis + 2])?.checked_sub(extra[axis])
        };
        let cut = [pads[0], pads[1], end(0)?, end(1)?];
        // With a stride of one, the convolution itself does the padding.
        let is_inside = stride > 1 || (0..4).all(|side| cut[side] < kernel[side % 2]);
        let cut = cut.map(|side| usize::try_from(side).ok());
        let [Some(top), Some(left), Some(bottom), Some(right)] = cut else { return None };
        let stride = usize::try_from(stride).ok()?;
        is_inside.then_some(Self { dims, weights, bias, stride, cut: [top, left, bottom, right] })
    }

    /// Returns the number of weights per phase along each axis.
    fn taps(&self) -> [usize; 2] {
        [self.dims[2], self.dims[3]].map(|side| side.div_ceil(self.stride))
    }

    /// Returns the weights of the convolution: `[outputs * stride * stride, inputs, taps, taps]`.
    fn kernel(&self) -> Option<Array> {
        let [inputs, outputs, height, width] = self.dims;
        let (stride, [down, across]) = (self.stride, self.taps());
        let channels = outputs * stride * stride;
        let mut kernel = Vec::with_capacity(channels * inputs * down * across);
        for channel in 0..channels {
            let (output, y, x) = (channel / (stride * stride), channel / stride % stride, channel % stride);
            for input in 0..inputs {
                for tap in 0..down * across {
                    // A convolution applies the taps in reverse order.
                    let row = y + stride * (down - 1 - tap / across);
                    let column = x + stride * (across - 1 - tap % across);
                    let is_there = row < height && column < width;
                    let at = ((input * outputs + output) * height + row) * width + column;
                    kernel.push(if is_there { *self.weights.get(at)? } else { 0.0 });
                }
            }
        }
        Array::new(vec![channels, inputs, down, across], Data::Float(kernel))
    }

    fn split(&self, node: &NodeProto) -> Option<Split> {
        let ([x, ..], [output]) = (node.input.as_slice(), node.output.as_slice()) else { return None };
        let [weights, bias, kinds, whole, from, to, axes] =
            ["weights", "bias", "kinds", "whole", "from", "to", "axes"]
                .map(|part| format!("{output}/{part}"));
        let mut split = Split::default().constant(&weights, &self.kernel()?)?;
        let mut inputs = vec![x.as_str(), weights.as_str()];
        if let Some(values) = &self.bias {
            let all: Vec<f32> = values
                .iter()
                .flat_map(|value| std::iter::repeat_n(*value, self.stride * self.stride))
                .collect();
            split = split.constant(&bias, &Array::new(vec![all.len()], Data::Float(all))?)?;
            inputs.push(&bias);
        }
        let [down, across] = self.taps().map(|taps| taps as i64);
        let conv = Operator::new("Conv").ints("kernel_shape", [down, across]);
        if self.stride == 1 {
            let around = [down, across, down, across];
            let pads = around.iter().zip(self.cut).map(|(taps, cut)| taps - 1 - cut as i64);
            return Some(split.node(conv.ints("pads", pads), &inputs, output));
        }
        let conv = conv.ints("pads", [down - 1, across - 1, down - 1, across - 1]);
        let to_space = Operator::new("DepthToSpace").int("blocksize", self.stride as i64).text("mode", "CRD");
        let split = split.node(conv, &inputs, &kinds);
        if self.cut == [0; 4] {
            return Some(split.node(to_space, &[&kinds], output));
        }
        let [top, left, bottom, right] = self.cut.map(|side| side as i64);
        let end = |cut: i64| if cut == 0 { i64::MAX } else { -cut };
        let split = split
            .constant(&from, &Array::ints(vec![top, left]))?
            .constant(&to, &Array::ints(vec![end(bottom), end(right)]))?
            .constant(&axes, &Array::ints(vec![2, 3]))?;
        Some(split.node(to_space, &[&kinds], &whole).node(
            Operator::new("Slice"),
            &[&whole, &from, &to, &axes],
            output,
        ))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::proto::TensorProto;

    const DIMS: [usize; 4] = [2, 3, 4, 4];

    fn weights() -> TensorProto {
        let values = (0..DIMS.iter().product()).map(|at| at as f32).collect();
        Array::new(DIMS.to_vec(), Data::Float(values)).unwrap().to_tensor("w").unwrap()
    }

    fn graph(operator: Operator) -> GraphProto {
        let input = ["x", "w"].map(str::to_owned).to_vec();
        let node = NodeProto { input, output: vec!["y".to_owned()], ..operator.into_node("y") };
        GraphProto { node: vec![node], initializer: vec![weights()], ..GraphProto::default() }
    }

    fn transposed() -> Operator {
        Operator::new("ConvTranspose")
    }

    fn operators(graph: &GraphProto) -> Vec<&str> {
        graph.node.iter().map(|node| node.op_type.as_str()).collect()
    }

    fn constant(graph: &GraphProto, name: &str) -> Array {
        Array::from_tensor(graph.initializer.iter().find(|tensor| tensor.name == name).unwrap()).unwrap()
    }

    #[test]
    fn stride_of_two_has_four_phases() {
        let mut graph = graph(transposed().ints("strides", [2, 2]).ints("pads", [1, 1, 1, 1]));
        assert!(transposed_conv_to_conv(&mut graph));
        assert_eq!(operators(&graph), ["Conv", "DepthToSpace", "Slice"]);
        assert_eq!(graph.node[2].output, ["y"]);
        let kernel = constant(&graph, "y/weights");
        assert_eq!(kernel.dims(), [12, 2, 2, 2]);
        // The second phase of the first output uses columns 3 and 1 of rows 2 and 0.
        assert_eq!(kernel.as_floats().unwrap()[8..12], [11.0, 9.0, 3.0, 1.0]);
        assert_eq!(constant(&graph, "y/from").as_ints().unwrap(), [1, 1]);
        assert_eq!(constant(&graph, "y/to").as_ints().unwrap(), [-1, -1]);
    }

    #[test]
    fn without_padding_nothing_is_cut_and_without_stride_nothing_is_moved() {
        let mut whole = graph(transposed().ints("strides", [4, 4]));
        assert!(transposed_conv_to_conv(&mut whole));
        assert_eq!(operators(&whole), ["Conv", "DepthToSpace"]);
        let mut still = graph(transposed().ints("pads", [1, 1, 2, 2]));
        assert!(transposed_conv_to_conv(&mut still));
        assert_eq!(operators(&still), ["Conv"]);
        assert_eq!(still.node[0].ints("pads").unwrap(), [2, 2, 1, 1]);
        assert_eq!(constant(&still, "y/weights").as_floats().unwrap()[..2], [15.0, 14.0]);
    }

    #[test]
    fn unsupported_variants_are_unchanged() {
        for operator in [
            transposed().int("group", 2),
            transposed().ints("dilations", [2, 2]),
            transposed().ints("strides", [1, 2]),
            transposed().ints("strides", [0, 0]),
            transposed().ints("strides", [2, 2]).ints("output_shape", [9, 9]),
            transposed().text("auto_pad", "SAME_UPPER"),
            transposed().ints("pads", [4, 4, 4, 4]),
            transposed().ints("pads", [i64::MAX, 0, i64::MIN, 0]),
            transposed().ints("strides", [2, 2]).ints("output_padding", [1, 1]),
            transposed().ints("kernel_shape", [3, 3]),
        ] {
            let mut graph = graph(operator);
            assert!(!transposed_conv_to_conv(&mut graph));
            assert_eq!(operators(&graph), ["ConvTranspose"]);
        }
        let mut taken = graph(transposed().ints("strides", [2, 2]));
        taken.initializer.push(Array::ints(vec![0]).to_tensor("y/kinds").unwrap());
        assert!(!transposed_conv_to_conv(&mut taken));
    }
}
