//! Export of policies to ONNX.

use std::ops::Range;

use opendr_engine::{Error, Result};
use opendr_kernels::{Activation, Gru, Layer, Network};
use opendr_onnx::{
    Array, Builder, Data, ElementType, GraphTensor, Operator, bytes_from_model, model_from_graph,
};

use crate::policy::{Bounds, Choices, EPSILON, Head, ObservationNormaliser, PartKind, Policy};

/// Returns the bytes of an ONNX model of a policy's most likely actions, with pre- and post-processing: normalisation of
/// observations, scaling of images to [0, 1], argmax, bounds of actions.
///
/// The input `observation` is `[batch, numbers]`, as the environment returns it. The output `action` is `[batch, numbers]`, as the
/// environment takes it (int64 for discrete and binary actions). The output `network` holds the raw outputs of the network: logits, or
/// means before squashing or clipping. A recurrent policy also has the input `state`, `[batch, numbers]`, zero at the start of an
/// episode, and the output `next_state`.
///
/// # Errors
/// `Unsupported` for discrete observations and for layer normalisation.
pub fn onnx_from_policy(policy: &Policy) -> Result<Vec<u8>> {
    let mut graph = Graph { builder: Builder::default() };
    graph.builder.reserve("action");
    graph.builder.reserve("network");
    graph.builder.reserve("next_state");
    let raw = policy.encoder.raw_len();
    let observation =
        graph.builder.input("observation", ElementType::Float, vec![None, Some(raw)], &["batch", ""]);
    let features = graph.features(policy, &observation)?;
    let first = policy.extractor.parameters();
    let parameters = &policy.parameters[first..first + policy.trunk.parameters()];
    let (of_gru, of_network) = parameters.split_at(policy.trunk.recurrent_parameters());
    let features = match policy.trunk.gru() {
        None => features,
        Some(gru) => graph.recurrent_unit(gru, of_gru, &features)?,
    };
    let network = policy.trunk.network();
    let outputs = match policy.trunk.choices() {
        None => graph.network(network, of_network, features)?,
        Some(choices) => graph.scores(choices, network, of_network, &features)?,
    };
    graph.builder.output("network", &outputs, "the raw output of the network", &["batch", ""])?;
    let action = graph.action(&policy.head, &outputs)?;
    graph.builder.output("action", &action, "the most likely action", &["batch", ""])?;
    Ok(bytes_from_model(&model_from_graph(graph.builder.finish("policy"))))
}

struct Graph {
    builder: Builder,
}

impl Graph {
    fn add(&mut self, operator: Operator, inputs: &[&GraphTensor], width: usize) -> Result<GraphTensor> {
        self.builder.add("", operator, inputs, ElementType::Float, vec![None, Some(width)])
    }

    /// Adds the encoding of an observation and the networks of its images. Returns the features.
    fn features(&mut self, policy: &Policy, observation: &GraphTensor) -> Result<GraphTensor> {
        let encoder = &policy.encoder;
        let (mut features, mut number) = (Vec::new(), 0);
        for (part, (_, network)) in encoder.parts().iter().zip(policy.extractor.parts()) {
            let raw = match encoder.parts() {
                [_] => observation.clone(),
                _ => self.slice(observation, part.raw.clone())?,
            };
            let encoded = match (&part.kind, &encoder.normaliser) {
                (PartKind::Numbers, None) => raw,
                (PartKind::Numbers, Some(normaliser)) => {
                    number += part.raw.len();
                    self.normalised(raw, normaliser, number - part.raw.len(), part.raw.len())?
                }
                (PartKind::Image { low, scale, .. }, _) => {
                    let width = part.raw.len();
                    let shifted =
                        self.add(Operator::new("Sub"), &[&raw, &GraphTensor::scalar(*low)], width)?;
                    self.add(Operator::new("Mul"), &[&shifted, &GraphTensor::scalar(*scale)], width)?
                }
                (PartKind::Choices(..), _) => {
                    return Err(Error::unsupported(
                        "policies with discrete observations cannot be exported to ONNX; use a box of numbers",
                    ));
                }
            };
            features.push(match (network, &part.kind) {
                (Some((network, range)), PartKind::Image { shape, .. }) => {
                    self.image_network(network, &policy.parameters[range], *shape, encoded)?
                }
                _ => encoded,
            });
        }
        match &features[..] {
            [only] => Ok(only.clone()),
            several => {
                let several: Vec<_> = several.iter().collect();
                self.add(Operator::new("Concat").int("axis", 1), &several, policy.extractor.outputs())
            }
        }
    }

    fn slice(&mut self, of: &GraphTensor, columns: Range<usize>) -> Result<GraphTensor> {
        let ends = [columns.start as i64, columns.end as i64].map(|end| GraphTensor::ints([end]));
        self.add(Operator::new("Slice"), &[of, &ends[0], &ends[1], &GraphTensor::ints([1])], columns.len())
    }

    /// Adds a network that scores each choice by its own features and the common ones.
    fn scores(
        &mut self,
        Choices { count, own }: Choices,
        network: &Network,
        parameters: &[f32],
        features: &GraphTensor,
    ) -> Result<GraphTensor> {
        let (common, mut scores) = (network.inputs() - own, Vec::new());
        for choice in 0..count {
            let mut row = self.slice(features, choice * own..(choice + 1) * own)?;
            if common > 0 {
                let common = self.slice(features, count * own..count * own + common)?;
                row = self.add(Operator::new("Concat").int("axis", 1), &[&row, &common], network.inputs())?;
            }
            scores.push(self.network(network, parameters, row)?);
        }
        let scores: Vec<_> = scores.iter().collect();
        self.add(Operator::new("Concat").int("axis", 1), &scores, count)
    }

    fn normalised(
        &mut self,
        raw: GraphTensor,
        normaliser: &ObservationNormaliser,
        first: usize,
        width: usize,
    ) -> Result<GraphTensor> {
        let moments = &normaliser.moments;
        let mean = moments.mean()[first..first + width].iter().map(|mean| *mean as f32);
        let variance = moments.variance()[first..first + width].iter();
        let deviation = variance.map(|variance| (variance + EPSILON).sqrt() as f32);
        let (mean, deviation) = (row(mean.collect())?, row(deviation.collect())?);
        let shifted = self.add(Operator::new("Sub"), &[&raw, &mean], width)?;
        let scaled = self.add(Operator::new("Div"), &[&shifted, &deviation], width)?;
        let clip = normaliser.clip;
        self.add(
            Operator::new("Clip"),
            &[&scaled, &GraphTensor::scalar(-clip), &GraphTensor::scalar(clip)],
            width,
        )
    }

    /// Adds a recurrent unit on features and `state`, as [`Gru`] computes it.
    fn recurrent_unit(
        &mut self,
        gru: &Gru,
        parameters: &[f32],
        features: &GraphTensor,
    ) -> Result<GraphTensor> {
        let (inputs, size) = (gru.inputs(), gru.size());
        let state = self.builder.input("state", ElementType::Float, vec![None, Some(size)], &["batch", ""]);
        let (weights, rest) = parameters.split_at(3 * size * inputs);
        let (recurrent, biases) = rest.split_at(3 * size * size);
        let mut sums = |x: &GraphTensor, weights: &[f32], biases: &[f32]| {
            let weights = constant(vec![weights.len() / (3 * size), 3 * size], weights)?;
            let biases = constant(vec![3 * size], biases)?;
            self.add(Operator::new("Gemm"), &[x, &weights, &biases], 3 * size)
        };
        let of_features = sums(features, weights, &biases[..3 * size])?;
        let of_state = sums(&state, recurrent, &biases[3 * size..])?;
        let mut gates = Vec::new();
        for gate in 0..3 {
            let ends = [gate, gate + 1].map(|end| GraphTensor::ints([(end * size) as i64]));
            let mut own = |of: &GraphTensor| {
                let inputs = [of, &ends[0], &ends[1], &GraphTensor::ints([1])];
                self.add(Operator::new("Slice"), &inputs, size)
            };
            let (of_features, mut of_state) = (own(&of_features)?, own(&of_state)?);
            if let [reset, _] = &gates[..] {
                of_state = self.add(Operator::new("Mul"), &[reset, &of_state], size)?;
            }
            let sum = self.add(Operator::new("Add"), &[&of_features, &of_state], size)?;
            let activation = if gate == 2 { Activation::Tanh } else { Activation::Sigmoid };
            gates.push(self.activation(activation, sum)?);
        }
        let [_, kept, candidate] = &gates[..] else {
            return Err(Error::internal("a recurrent unit without three gates"));
        };
        // (1 - z) n + z h is n + z (h - n).
        let change = self.add(Operator::new("Sub"), &[&state, candidate], size)?;
        let change = self.add(Operator::new("Mul"), &[kept, &change], size)?;
        let next = self.add(Operator::new("Add"), &[candidate, &change], size)?;
        self.builder.output("next_state", &next, "the next recurrent state", &["batch", ""])?;
        Ok(next)
    }

    /// Adds the convolutions of an image and flattens the result.
    fn image_network(
        &mut self,
        network: &Network,
        parameters: &[f32],
        shape: [usize; 3],
        flat: GraphTensor,
    ) -> Result<GraphTensor> {
        let sizes = shape.map(|size| size as i64);
        let reshape = GraphTensor::ints([-1, sizes[0], sizes[1], sizes[2]]);
        let dims = vec![None, Some(shape[0]), Some(shape[1]), Some(shape[2])];
        let image =
            self.builder.add("", Operator::new("Reshape"), &[&flat, &reshape], ElementType::Float, dims)?;
        self.network(network, parameters, image)
    }

    fn network(&mut self, network: &Network, parameters: &[f32], from: GraphTensor) -> Result<GraphTensor> {
        let mut wire = from;
        for (index, layer) in network.layers().iter().enumerate() {
            let own = &parameters[network.parameter_range(index)];
            wire = match layer {
                Layer::Dense(dense) => {
                    let (inputs, outputs) = (dense.inputs(), dense.outputs());
                    if wire.rank() > 2 {
                        wire = self.add(Operator::new("Flatten").int("axis", 1), &[&wire], inputs)?;
                    }
                    let (weights, biases) = own.split_at(inputs * outputs);
                    let (weights, biases) =
                        (constant(vec![inputs, outputs], weights)?, constant(vec![outputs], biases)?);
                    let product = self.add(Operator::new("Gemm"), &[&wire, &weights, &biases], outputs)?;
                    self.activation(dense.activation(), product)?
                }
                Layer::Conv2d(convolution) => {
                    let ([inputs, ..], [outputs, ..]) =
                        (convolution.input_shape(), convolution.output_shape());
                    let kernel = convolution.kernel();
                    let (weights, biases) = own.split_at(own.len() - outputs);
                    let weights = constant(vec![outputs, inputs, kernel[0], kernel[1]], weights)?;
                    let biases = constant(vec![outputs], biases)?;
                    let [stride, padding] = [convolution.stride(), convolution.padding()];
                    let whole = |sizes: [usize; 2]| sizes.map(|size| size as i64);
                    let pads = [padding[0], padding[1], padding[0], padding[1]].map(|side| side as i64);
                    let operator = Operator::new("Conv").ints("strides", whole(stride)).ints("pads", pads);
                    let [_, height, width] = convolution.output_shape();
                    let dims = vec![None, Some(outputs), Some(height), Some(width)];
                    let inputs = [&wire, &weights, &biases];
                    let convolved = self.builder.add("", operator, &inputs, ElementType::Float, dims)?;
                    self.activation(convolution.activation(), convolved)?
                }
                Layer::Activation(activation, _) => self.activation(*activation, wire)?,
                Layer::LayerNorm(_) => {
                    return Err(Error::unsupported("layer normalisation cannot be exported to ONNX"));
                }
            };
        }
        Ok(wire)
    }

    fn activation(&mut self, activation: Activation, wire: GraphTensor) -> Result<GraphTensor> {
        let name = match activation {
            Activation::Identity => return Ok(wire),
            Activation::Relu => "Relu",
            Activation::Tanh => "Tanh",
            Activation::Sigmoid => "Sigmoid",
        };
        let dims = wire.dims().to_vec();
        self.builder.add("", Operator::new(name), &[&wire], ElementType::Float, dims)
    }

    fn action(&mut self, head: &Head, outputs: &GraphTensor) -> Result<GraphTensor> {
        let axes = head.action_len();
        match head {
            Head::Categorical { counts, start } => {
                let mut begin = 0;
                let mut choices = Vec::new();
                for count in counts {
                    let end = begin + *count as usize;
                    let own = match counts.len() {
                        1 => outputs.clone(),
                        _ => {
                            let ends = [begin as i64, end as i64].map(|end| GraphTensor::ints([end]));
                            let inputs = [outputs, &ends[0], &ends[1], &GraphTensor::ints([1])];
                            self.add(Operator::new("Slice"), &inputs, end - begin)?
                        }
                    };
                    choices.push(self.largest(&own, *start)?);
                    begin = end;
                }
                match &choices[..] {
                    [only] => Ok(only.clone()),
                    several => {
                        let (several, dims): (Vec<_>, _) = (several.iter().collect(), vec![None, Some(axes)]);
                        let concat = Operator::new("Concat").int("axis", 1);
                        self.builder.add("", concat, &several, ElementType::Int, dims)
                    }
                }
            }
            Head::Greedy { start, .. } => self.largest(outputs, *start),
            Head::Binary(_) => {
                let dims = vec![None, Some(axes)];
                let (above, zero) = (Operator::new("Greater"), GraphTensor::scalar(0.0));
                let digits =
                    self.builder.add("", above, &[outputs, &zero], ElementType::Bool, dims.clone())?;
                let cast = Operator::new("Cast").int("to", ElementType::Int.data_type() as i64);
                self.builder.add("", cast, &[&digits], ElementType::Int, dims)
            }
            Head::Gaussian(bounds) => self.clipped(outputs, bounds),
            Head::Squashed(bounds) => {
                let squashed = self.activation(Activation::Tanh, outputs.clone())?;
                self.stretched(&squashed, bounds)
            }
            Head::SquashedGaussian(bounds) => {
                let end = GraphTensor::ints([axes as i64]);
                let inputs = [outputs, &GraphTensor::ints([0]), &end, &GraphTensor::ints([1])];
                let means = self.add(Operator::new("Slice"), &inputs, axes)?;
                let squashed = self.activation(Activation::Tanh, means)?;
                self.stretched(&squashed, bounds)
            }
        }
    }

    fn largest(&mut self, scores: &GraphTensor, start: i32) -> Result<GraphTensor> {
        let operator = Operator::new("ArgMax").int("axis", 1).int("keepdims", 1);
        let dims = vec![None, Some(1)];
        let place = self.builder.add("", operator, &[scores], ElementType::Int, dims.clone())?;
        match start {
            0 => Ok(place),
            start => {
                let start = GraphTensor::ints([start.into()]);
                self.builder.add("", Operator::new("Add"), &[&place, &start], ElementType::Int, dims)
            }
        }
    }

    fn clipped(&mut self, actions: &GraphTensor, bounds: &Bounds) -> Result<GraphTensor> {
        let width = bounds.low.len();
        let (low, high) = (row(bounds.low.clone())?, row(bounds.high.clone())?);
        let above = self.add(Operator::new("Max"), &[actions, &low], width)?;
        self.add(Operator::new("Min"), &[&above, &high], width)
    }

    /// As [`Bounds::stretch`].
    fn stretched(&mut self, actions: &GraphTensor, bounds: &Bounds) -> Result<GraphTensor> {
        let width = bounds.low.len();
        let both = bounds.low.iter().zip(&bounds.high);
        let half = row(both.map(|(low, high)| 0.5 * (high - low)).collect())?;
        let above = self.add(Operator::new("Add"), &[actions, &GraphTensor::scalar(1.0)], width)?;
        let scaled = self.add(Operator::new("Mul"), &[&above, &half], width)?;
        let moved = self.add(Operator::new("Add"), &[&scaled, &row(bounds.low.clone())?], width)?;
        self.clipped(&moved, bounds)
    }
}

fn row(numbers: Vec<f32>) -> Result<GraphTensor> {
    let dims = vec![1, numbers.len()];
    constant(dims, &numbers)
}

fn constant(dims: Vec<usize>, numbers: &[f32]) -> Result<GraphTensor> {
    let array = Array::new(dims, Data::Float(numbers.to_vec()));
    array
        .map(GraphTensor::constant)
        .ok_or_else(|| Error::internal("the size of a constant does not match its shape"))
}
