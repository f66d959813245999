//! What probably lies where the camera has not looked.

use opendr_engine::{Error, Result};

use super::HALF_TRACK;
use super::map_raster::{CELLS, MapRaster, ROWS};
use super::way_costs::BLOCKED;

/// How likely a place of the map is too near to something, learnt from corridors whose obstacles were known: a depth camera shows
/// fronts only, and behind a front lies the obstacle.
///
/// A network with one hidden layer, from [`FEATURES`](Self::FEATURES) numbers of a cell and the cells around it to the probabilities that
/// something is nearer than 0.3 m, and nearer than 0.55 m.
#[derive(Debug, Clone, PartialEq)]
pub struct Surroundings {
    parameters: Vec<f32>,
}

/// What a metre costs where something is nearer than 0.3 m, and where it is nearer than 0.55 m, beyond the metre itself.
const GAINS: [f32; 2] = [9.0, 1.0];

impl Surroundings {
    /// Numbers that the network takes of a cell.
    pub const FEATURES: usize = super::map_raster::FEATURES;
    /// Neurons of the hidden layer.
    pub const HIDDEN: usize = 24;
    /// Probabilities that it gives.
    pub const OUTPUTS: usize = 2;
    /// Metres nearer than which something is too near, and would better not be.
    pub const DISTANCES: [f32; 2] = [0.3, 0.55];
    /// Numbers of its parameters: weights `[FEATURES, HIDDEN]`, biases, weights `[HIDDEN, OUTPUTS]`, biases.
    pub const PARAMETERS: usize = (Self::FEATURES + 1) * Self::HIDDEN + (Self::HIDDEN + 1) * Self::OUTPUTS;

    /// Creates the network with these parameters.
    ///
    /// # Errors
    /// `Format` when they are of another number or not finite.
    pub fn new(parameters: Vec<f32>) -> Result<Self> {
        if parameters.len() == Self::PARAMETERS && parameters.iter().all(|parameter| parameter.is_finite()) {
            return Ok(Self { parameters });
        }
        Err(Error::format(format!(
            "{} parameters of surroundings; {} finite ones belong there, train the policy again",
            parameters.len(),
            Self::PARAMETERS
        )))
    }

    /// Returns all parameters.
    pub fn parameters(&self) -> &[f32] {
        &self.parameters
    }

    /// Returns the probabilities of one cell.
    pub fn probabilities(&self, features: &[f32; Self::FEATURES]) -> [f32; Self::OUTPUTS] {
        let (first, rest) = self.parameters.split_at(Self::FEATURES * Self::HIDDEN);
        let (biases, rest) = rest.split_at(Self::HIDDEN);
        let (second, last) = rest.split_at(Self::HIDDEN * Self::OUTPUTS);
        let mut hidden = [0.0; Self::HIDDEN];
        hidden.copy_from_slice(biases);
        for (feature, row) in features.iter().zip(first.as_chunks::<{ Self::HIDDEN }>().0) {
            for (neuron, weight) in hidden.iter_mut().zip(row) {
                *neuron += feature * weight;
            }
        }
        let mut logits = [last[0], last[1]];
        for (neuron, row) in hidden.iter().zip(second.as_chunks::<{ Self::OUTPUTS }>().0) {
            let neuron = neuron.max(0.0);
            logits = [logits[0] + neuron * row[0], logits[1] + neuron * row[1]];
        }
        logits.map(|logit| 1.0 / (1.0 + (-logit).exp()))
    }

    /// Writes what a metre costs in each cell: the expectation.
    pub(super) fn weigh(&self, raster: &MapRaster, weights: &mut [f32]) {
        let mut features = [0.0; Self::FEATURES];
        for (cell, weight) in weights.iter_mut().enumerate().take(CELLS) {
            *weight = match () {
                () if raster.side(cell % ROWS).abs() > HALF_TRACK - BLOCKED.0 => BLOCKED.1,
                () if raster.is_clear(cell) => 1.0,
                () => {
                    raster.features(cell, &mut features);
                    let probabilities = self.probabilities(&features);
                    1.0 + probabilities.iter().zip(GAINS).map(|(likely, gain)| likely * gain).sum::<f32>()
                }
            };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_is_a_network_of_one_hidden_layer() {
        assert!(Surroundings::new(vec![0.0; 3]).is_err());
        assert!(Surroundings::new(vec![f32::NAN; Surroundings::PARAMETERS]).is_err());
        let mut parameters = vec![0.0; Surroundings::PARAMETERS];
        let even = Surroundings::new(parameters.clone()).unwrap();
        assert_eq!(even.probabilities(&[1.0; Surroundings::FEATURES]), [0.5; 2]);
        // The third feature to the fifth neuron, and that to the second output.
        parameters[2 * Surroundings::HIDDEN + 4] = 2.0;
        let second = (Surroundings::FEATURES + 1) * Surroundings::HIDDEN;
        parameters[second + 4 * 2 + 1] = 0.5;
        let network = Surroundings::new(parameters).unwrap();
        let mut features = [0.0; Surroundings::FEATURES];
        features[2] = 3.0;
        let [first, other] = network.probabilities(&features);
        assert!(first == 0.5 && (other - 1.0 / (1.0 + (-3.0f32).exp())).abs() < 1e-6);
        features[2] = -3.0;
        assert_eq!(network.probabilities(&features), [0.5; 2]);
    }
}
