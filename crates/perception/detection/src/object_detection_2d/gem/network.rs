//! GEM's network for training: a backbone per sensor, a gate per level, and one detector for the fused features.

use burn::module::Module;
use burn::nn::{Initializer, Linear, LinearConfig};
use burn::tensor::activation::{relu, softmax};
use burn::tensor::{Device, Tensor};

use crate::object_detection_2d::single_shot_detector::network::{LevelOutput, Network, NetworkConfig, Trunk};

/// Number of hidden features of a gate.
const FEATURES: usize = 32;

/// A detector with two sensors as inputs.
#[derive(Module, Debug)]
pub struct GemNetwork {
    /// Backbone of the colour image, and detector for the fused features.
    detector: Network,
    infrared: Trunk,
    gates: Vec<Gate>,
}

/// Weights of the two sensors, computed from the global means of their features.
#[derive(Module, Debug)]
struct Gate {
    hidden: Linear,
    logits: Linear,
}

impl GemNetwork {
    /// Creates a network with random weights; both sensors have equal weights.
    pub fn new(config: &NetworkConfig, device: &Device) -> Self {
        let infrared = config.trunk(device);
        let gates = infrared.channels().into_iter().map(|channels| Gate::new(channels, device)).collect();
        Self { detector: config.init(device), infrared, gates }
    }

    /// Returns the outputs of all levels, finest first, and the weights of the sensors, `[batch, 2]` with rows of sum one,
    /// for images `[batch, 3, height, width]` of both.
    pub fn forward(&self, colour: Tensor<4>, infrared: Tensor<4>) -> (Vec<LevelOutput>, Tensor<2>) {
        let both = self.detector.trunk(colour).into_iter().zip(self.infrared.forward(infrared));
        let (mut fused, mut weights) = (Vec::new(), Vec::new());
        for (gate, (colour, infrared)) in self.gates.iter().zip(both) {
            let of_level = gate.forward(colour.clone(), infrared.clone());
            let [batch, _] = of_level.dims();
            let share = |sensor| of_level.clone().narrow(1, sensor, 1).reshape([batch, 1, 1, 1]);
            fused.push(colour * share(0) + infrared * share(1));
            weights.push(of_level);
        }
        let weights = Tensor::stack::<3>(weights, 0).mean_dim(0).squeeze_dim::<2>(0);
        (self.detector.forward_from(fused), weights)
    }
}

impl Gate {
    fn new(channels: usize, device: &Device) -> Self {
        let zeros = LinearConfig::new(FEATURES, 2).with_initializer(Initializer::Zeros);
        Self { hidden: LinearConfig::new(2 * channels, FEATURES).init(device), logits: zeros.init(device) }
    }

    /// Returns the weights `[batch, 2]`.
    fn forward(&self, colour: Tensor<4>, infrared: Tensor<4>) -> Tensor<2> {
        let [batch, channels, ..] = colour.dims();
        let mean = |features: Tensor<4>| features.mean_dim(2).mean_dim(3).reshape([batch, channels]);
        let both = Tensor::cat(vec![mean(colour), mean(infrared)], 1);
        softmax(self.logits.forward(relu(self.hidden.forward(both))), 1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_count_alike_before_training() {
        let device = Device::flex();
        let config = NetworkConfig { width: 0.25, strides: vec![8, 16, 32], kinds: 2, classes: 3 };
        let pictures = || Tensor::<4>::random([2, 3, 64, 96], burn::tensor::Distribution::Default, &device);
        let (levels, weights) = GemNetwork::new(&config, &device).forward(pictures(), pictures());
        assert_eq!(weights.into_data().iter::<f32>().collect::<Vec<_>>(), [0.5; 4]);
        let shapes: Vec<_> = levels.iter().map(|level| level.scores.dims()).collect();
        assert_eq!(shapes, [[2, 6, 8, 12], [2, 6, 4, 6], [2, 6, 2, 3]]);
    }
}
