//! Initial parameters of layers.

use opendr_engine::Random;
use opendr_kernels::Dense;

/// Writes weights of Glorot and Bengio (2010), uniform, and biases of 0.
pub(crate) fn initialise_dense(layer: &Dense, random: &mut Random, parameters: &mut [f32]) {
    let bound = (6.0 / (layer.inputs() + layer.outputs()) as f32).sqrt();
    let (weights, biases) = parameters.split_at_mut(layer.inputs() * layer.outputs());
    weights.iter_mut().for_each(|weight| *weight = random.uniform(-bound, bound));
    biases.fill(0.0);
}

/// Writes scales of 1 and shifts of 0.
pub(crate) fn initialise_norm(parameters: &mut [f32]) {
    let (scale, shift) = parameters.split_at_mut(parameters.len() / 2);
    scale.fill(1.0);
    shift.fill(0.0);
}

/// Writes vectors of the normal distribution with this standard deviation.
pub(crate) fn initialise_vectors(deviation: f32, random: &mut Random, parameters: &mut [f32]) {
    parameters.iter_mut().for_each(|number| *number = deviation * random.normal() as f32);
}
