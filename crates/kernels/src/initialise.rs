//! Initialisation of network parameters.

use opendr_engine::Random;

use crate::{Layer, Network};

/// Initialisation of the weights of a network; scales of a normalisation start at 1, its shifts at 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Initialisation {
    /// Orthogonal weights (Saxe, McClelland and Ganguli, 2014), and biases of 0; usual for policies.
    Orthogonal {
        /// Gain of all layers but the last; the square root of 2 for ReLU, and in Stable-Baselines3 for tanh too.
        hidden: f32,
        /// Gain of the last layer.
        output: f32,
    },
    /// Weights and biases uniform within 1 / sqrt(fan-in): PyTorch's default.
    Uniform,
}

impl Network {
    /// Writes initial parameters.
    ///
    /// # Panics
    /// When the length of `parameters` is not that of the network.
    pub fn initialise(&self, how: Initialisation, random: &mut Random, parameters: &mut [f32]) {
        assert_eq!(
            parameters.len(),
            self.parameters(),
            "`parameters` must have the length of the network's parameters"
        );
        let last = self.layers().iter().rposition(|layer| layer.neurons().is_some());
        for (index, layer) in self.layers().iter().enumerate() {
            let own = &mut parameters[self.parameter_range(index)];
            match (layer.neurons(), how) {
                (None, _) => {
                    let (scale, shift) = own.split_at_mut(own.len() / 2);
                    scale.fill(1.0);
                    shift.fill(0.0);
                }
                (Some([inputs, outputs]), Initialisation::Orthogonal { hidden, output }) => {
                    let (weights, biases) = own.split_at_mut(inputs * outputs);
                    let gain = if Some(index) == last { output } else { hidden };
                    orthogonal(inputs, outputs, gain, layer.keeps_inputs_in_rows(), random, weights);
                    biases.fill(0.0);
                }
                (Some([inputs, _]), Initialisation::Uniform) => {
                    let bound = 1.0 / (inputs as f32).sqrt();
                    own.iter_mut().for_each(|parameter| *parameter = random.uniform(-bound, bound));
                }
            }
        }
    }
}

impl Layer {
    /// Returns the fan-in of a neuron, and the number of neurons without shared weights.
    fn neurons(&self) -> Option<[usize; 2]> {
        match self {
            Self::Dense(layer) => Some([layer.inputs(), layer.outputs()]),
            Self::Conv2d(layer) => {
                let outputs = layer.output_shape()[0];
                Some([layer.parameters() / outputs - 1, outputs])
            }
            Self::LayerNorm(_) | Self::Activation(..) => None,
        }
    }

    /// Returns whether weights are stored by input, not by neuron.
    fn keeps_inputs_in_rows(&self) -> bool {
        matches!(self, Self::Dense(_))
    }
}

/// Writes weights whose rows, or columns where those are fewer, are orthogonal with norm `gain`: uniformly
/// distributed, because the directions of independent normal vectors are, and each is orthogonalised against those
/// before it.
fn orthogonal(
    inputs: usize,
    outputs: usize,
    gain: f32,
    inputs_in_rows: bool,
    random: &mut Random,
    weights: &mut [f32],
) {
    let (count, length) = (inputs.min(outputs), inputs.max(outputs));
    let mut vectors = vec![0.0f64; count * length];
    for index in 0..count {
        let (before, rest) = vectors.split_at_mut(index * length);
        let vector = &mut rest[..length];
        while !is_made_orthogonal(before, vector, random) {}
    }
    for input in 0..inputs {
        for output in 0..outputs {
            let at = if inputs <= outputs { input * length + output } else { output * length + input };
            let to = if inputs_in_rows { input * outputs + output } else { output * inputs + input };
            weights[to] = (f64::from(gain) * vectors[at]) as f32;
        }
    }
}

/// Makes a random vector a unit vector orthogonal to those before; returns `false` in the improbable case that
/// nothing remains.
fn is_made_orthogonal(before: &[f64], vector: &mut [f64], random: &mut Random) -> bool {
    vector.iter_mut().for_each(|number| *number = random.normal());
    // The second pass removes the rounding errors of the first.
    for _ in 0..2 {
        for other in before.chunks_exact(vector.len()) {
            let along: f64 = vector.iter().zip(other).map(|(number, other)| number * other).sum();
            vector.iter_mut().zip(other).for_each(|(number, other)| *number -= along * other);
        }
    }
    let norm = vector.iter().map(|number| number * number).sum::<f64>().sqrt();
    vector.iter_mut().for_each(|number| *number /= norm);
    norm > 1e-6
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Activation, Conv2d, Dense, LayerNorm};

    fn network() -> Network {
        let picture = Conv2d::new([2, 8, 8], 5, [3, 3], [2, 2], [1, 1], Activation::Relu).unwrap();
        Network::new(vec![
            Layer::Conv2d(picture),
            Layer::LayerNorm(LayerNorm::new(picture.outputs(), 1e-5).unwrap()),
            Layer::Dense(Dense::new(picture.outputs(), 7, Activation::Tanh).unwrap()),
            Layer::Activation(Activation::Tanh, 7),
            Layer::Dense(Dense::new(7, 11, Activation::Identity).unwrap()),
        ])
        .unwrap()
    }

    /// Checks the products of all pairs among `count` vectors; `at(vector, axis)` is an element.
    fn assert_orthogonal(count: usize, length: usize, gain: f64, at: impl Fn(usize, usize) -> f32) {
        for (i, j) in (0..count).flat_map(|i| (0..count).map(move |j| (i, j))) {
            let product: f64 = (0..length).map(|axis| f64::from(at(i, axis)) * f64::from(at(j, axis))).sum();
            let wanted = if i == j { gain * gain } else { 0.0 };
            assert!((product - wanted).abs() < 1e-5, "{i} {j}: {product}");
        }
    }

    #[test]
    fn weights_are_orthogonal() {
        let (network, mut random) = (network(), Random::new(1));
        let mut parameters = vec![9.0; network.parameters()];
        let how = Initialisation::Orthogonal { hidden: 1.5, output: 0.01 };
        network.initialise(how, &mut random, &mut parameters);
        let own = |index: usize| &parameters[network.parameter_range(index)];
        let (kernels, scales, dense, last) = (own(0), own(1), own(2), own(4));
        assert_orthogonal(5, 18, 1.5, |kernel, axis| kernels[kernel * 18 + axis]);
        assert_eq!(&kernels[5 * 18..], [0.0; 5]);
        assert!(scales[..80].iter().all(|scale| *scale == 1.0) && scales[80..] == [0.0; 80]);
        assert_orthogonal(7, 80, 1.5, |neuron, axis| dense[axis * 7 + neuron]);
        assert_orthogonal(7, 11, 0.01, |row, axis| last[row * 11 + axis]);
    }

    #[test]
    fn uniform_weights_fill_their_bounds() {
        let network = Network::dense(&[100, 50, 1], Activation::Relu).unwrap();
        let mut parameters = vec![9.0; network.parameters()];
        network.initialise(Initialisation::Uniform, &mut Random::new(1), &mut parameters);
        let largest = |range: std::ops::Range<usize>| {
            parameters[range].iter().fold(0.0f32, |most, parameter| most.max(parameter.abs()))
        };
        let (first, second) = (largest(network.parameter_range(0)), largest(network.parameter_range(1)));
        assert!((0.099..0.1).contains(&first) && (0.13..0.1415).contains(&second), "{first} {second}");
    }
}
