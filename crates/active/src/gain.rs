//! The expected rise of the probability of the true class by a motion.

use std::sync::Arc;

use opendr_engine::{Error, Random, Result};
use opendr_kernels::{Activation, Adam, AdamOptions, Compute, Initialisation, Network, Tape};

use crate::observation::Observer;
use crate::parameter_bytes;

/// Motions with their gains, to train on.
#[derive(Debug, Clone, Default)]
pub struct GainSamples {
    /// Observation and motion of each, one after the other.
    inputs: Vec<f32>,
    gains: Vec<f32>,
}

impl GainSamples {
    /// Adds a motion.
    pub fn add(&mut self, observation: &[f32], action: &[f32], gain: f32) {
        self.inputs.extend_from_slice(observation);
        self.inputs.extend_from_slice(action);
        self.gains.push(gain);
    }

    /// Returns the number of motions.
    pub fn len(&self) -> usize {
        self.gains.len()
    }

    /// Returns whether there is none.
    pub fn is_empty(&self) -> bool {
        self.gains.is_empty()
    }
}

/// A network from observation and motion to the expected gain.
#[derive(Debug, Clone)]
pub struct GainNetwork {
    network: Network,
    parameters: Arc<Vec<f32>>,
    axes: usize,
    tape: Tape,
    input: Vec<f32>,
}

fn network(axes: usize) -> Result<Network> {
    Network::dense(&[Observer::LEN + axes, 64, 32, 1], Activation::Relu)
}

const BATCH: usize = 128;
const RATE: f32 = 1e-3;

impl GainNetwork {
    /// Trains by least squares, `epochs` times over the samples.
    ///
    /// # Errors
    /// `InvalidInput` for fewer samples than a batch of 128.
    pub fn fit(
        samples: &GainSamples,
        axes: usize,
        epochs: usize,
        seed: u64,
        compute: &Compute,
    ) -> Result<Self> {
        let width = Observer::LEN + axes;
        if samples.len() < BATCH || samples.inputs.len() != width * samples.len() {
            return Err(Error::invalid_input(format!(
                "{} motions of {axes} axes to learn gains from; record at least {BATCH}",
                samples.len()
            )));
        }
        let network = network(axes)?;
        let mut random = Random::from_key([seed, 0x6a14]);
        let mut parameters = vec![0.0; network.parameters()];
        let begin = Initialisation::Orthogonal { hidden: std::f32::consts::SQRT_2, output: 0.1 };
        network.initialise(begin, &mut random, &mut parameters);
        let mut adam = Adam::new(parameters.len(), AdamOptions::default());
        let (mut tape, mut gradients) = (Tape::default(), vec![0.0; parameters.len()]);
        let mut order: Vec<usize> = (0..samples.len()).collect();
        let (mut x, mut dy) = (vec![0.0; BATCH * width], [0.0; BATCH]);
        let steps = epochs * (samples.len() / BATCH);
        for step in 0..steps {
            let at = step % (samples.len() / BATCH);
            if at == 0 {
                random.shuffle(&mut order);
            }
            let rows = &order[at * BATCH..(at + 1) * BATCH];
            for (to, row) in x.chunks_exact_mut(width).zip(rows) {
                to.copy_from_slice(&samples.inputs[row * width..(row + 1) * width]);
            }
            let predicted = network.forward(compute, &parameters, &x, &mut tape);
            for ((dy, predicted), row) in dy.iter_mut().zip(predicted).zip(rows) {
                *dy = 2.0 * (predicted - samples.gains[*row]) / BATCH as f32;
            }
            gradients.fill(0.0);
            network.backward(compute, &parameters, &dy, &mut tape, Some(&mut gradients), false);
            let rate = RATE * (1.0 - step as f32 / steps as f32);
            adam.step(compute, rate, &mut parameters, &gradients);
        }
        parameter_bytes::round(&mut parameters);
        Ok(Self::new(network, parameters, axes))
    }

    fn new(network: Network, parameters: Vec<f32>, axes: usize) -> Self {
        Self { network, parameters: Arc::new(parameters), axes, tape: Tape::default(), input: Vec::new() }
    }

    /// Returns the parameters as little-endian `f16`.
    pub fn to_bytes(&self) -> Vec<u8> {
        parameter_bytes::write(&self.parameters)
    }

    /// Creates a network from the bytes of [`Self::to_bytes`].
    ///
    /// # Errors
    /// Returns `Format` for bytes of another length.
    pub fn from_bytes(axes: usize, bytes: &[u8]) -> Result<Self> {
        let network = network(axes)?;
        let parameters = parameter_bytes::parse("the network of gains", bytes, network.parameters())?;
        Ok(Self::new(network, parameters, axes))
    }

    /// Predicts the expected gains of several motions, one after the other, from one observation.
    ///
    /// # Errors
    /// `InvalidInput` for an observation that is not of [`Observer::LEN`] numbers and for motions of another number of axes, `Internal`
    /// if damaged parameters give gains that are not finite.
    pub fn predict(&mut self, compute: &Compute, observation: &[f32], actions: &[f32]) -> Result<&[f32]> {
        if observation.len() != Observer::LEN || !actions.len().is_multiple_of(self.axes) {
            return Err(Error::invalid_input(format!(
                "an observation of {} numbers and motions of {} in all; give {} and {} for each motion",
                observation.len(),
                actions.len(),
                Observer::LEN,
                self.axes
            )));
        }
        self.input.clear();
        for action in actions.chunks_exact(self.axes) {
            self.input.extend_from_slice(observation);
            self.input.extend_from_slice(action);
        }
        let gains = self.network.forward(compute, &self.parameters, &self.input, &mut self.tape);
        match gains.iter().find(|gain| !gain.is_finite()) {
            None => Ok(gains),
            Some(gain) => Err(Error::internal(format!(
                "the network of gains returned {gain}, its parameters are damaged; load or train it again"
            ))),
        }
    }

    /// Returns the number of axes of a motion.
    pub fn axes(&self) -> usize {
        self.axes
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gains_that_depend_on_the_motion_are_learnt() {
        let (mut random, mut samples) = (Random::new(2), GainSamples::default());
        let mut observation = vec![0.0; Observer::LEN];
        for _ in 0..4000 {
            observation[3] = random.uniform(-1.0, 1.0);
            let action = [random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0)];
            samples.add(&observation, &action, 0.5 * observation[3] * action[0]);
        }
        let compute = Compute::single();
        let mut network = GainNetwork::fit(&samples, 2, 12, 1, &compute).unwrap();
        observation[3] = 0.8;
        let gains = network.predict(&compute, &observation, &[1.0, 0.0, -1.0, 0.0, 0.0, 1.0]).unwrap();
        assert!(
            (gains[0] - 0.4).abs() < 0.1 && (gains[1] + 0.4).abs() < 0.1 && gains[2].abs() < 0.1,
            "{gains:?}"
        );
        assert!(network.predict(&compute, &observation[1..], &[1.0, 0.0]).is_err());
        assert!(network.predict(&compute, &observation, &[1.0, 0.0, 1.0]).is_err());
        assert!(GainNetwork::fit(&GainSamples::default(), 2, 1, 1, &compute).is_err());
    }
}
