//! Reparameterised samples of a squashed Gaussian distribution, with gradients.

use opendr_engine::Random;
use opendr_kernels::{Isa, exp_in_place, tanh_in_place};

use crate::policy::LOG_STD_BOUNDS;

/// ln(2 pi) / 2.
const HALF_LOG_TAU: f32 = 0.918_938_5;

/// Keeps the logarithm finite for a saturated action.
const SATURATED: f32 = 1e-6;

/// Sampled actions in [-1, 1], and reused work memory.
#[derive(Debug, Clone, Default)]
pub(super) struct Squashed {
    pub actions: Vec<f32>,
    /// Log-density of each row's action.
    pub log_probabilities: Vec<f32>,
    /// Gradient of the network's outputs.
    pub doutputs: Vec<f32>,
    noise: Vec<f32>,
    deviations: Vec<f32>,
}

impl Squashed {
    /// Samples from rows of `axes` means followed by `axes` log standard deviations.
    pub fn sample(&mut self, isa: Isa, outputs: &[f32], axes: usize, random: &mut Random) {
        let Self { actions, log_probabilities, noise, deviations, .. } = self;
        for row in [&mut *actions, &mut *log_probabilities, &mut *noise, &mut *deviations] {
            row.clear();
        }
        for outputs in outputs.chunks_exact(2 * axes) {
            let log_stds = outputs[axes..].iter().map(|log_std| clamped(*log_std));
            deviations.extend(log_stds.clone());
            let first = noise.len();
            noise.extend((0..axes).map(|_| random.normal() as f32));
            let terms = log_stds.zip(&noise[first..]);
            log_probabilities
                .push(terms.map(|(log_std, noise)| -0.5 * noise * noise - log_std - HALF_LOG_TAU).sum());
        }
        exp_in_place(isa, deviations);
        let rows =
            outputs.chunks_exact(2 * axes).zip(deviations.chunks_exact(axes).zip(noise.chunks_exact(axes)));
        for (outputs, (deviations, noise)) in rows {
            let axes = outputs.iter().zip(deviations.iter().zip(noise));
            actions.extend(axes.map(|(mean, (deviation, noise))| mean + deviation * noise));
        }
        tanh_in_place(isa, actions);
        for (log, actions) in log_probabilities.iter_mut().zip(actions.chunks_exact(axes)) {
            *log -= actions.iter().map(|action| (1.0 - action * action + SATURATED).ln()).sum::<f32>();
        }
    }

    pub fn mean_log_probability(&self) -> f32 {
        self.log_probabilities.iter().sum::<f32>() / self.log_probabilities.len().max(1) as f32
    }

    /// Computes the gradient of the network's outputs for a loss of `weight` times the sum of the log-probabilities, plus a term with
    /// the gradient `dactions` with respect to the actions. The noise is that of the last sample.
    pub fn backward(&mut self, outputs: &[f32], weight: f32, dactions: &[f32]) {
        let axes = self.actions.len() / self.log_probabilities.len().max(1);
        self.doutputs.resize(outputs.len(), 0.0);
        let rows = outputs.chunks_exact(2 * axes).zip(self.doutputs.chunks_exact_mut(2 * axes));
        for (row, (outputs, doutputs)) in rows.enumerate() {
            for axis in 0..axes {
                let at = row * axes + axis;
                let (action, slope) = (self.actions[at], 1.0 - self.actions[at] * self.actions[at]);
                let of_density = weight * 2.0 * action * slope / (slope + SATURATED);
                let dmean = of_density + dactions[at] * slope;
                doutputs[axis] = dmean;
                let log_std = outputs[axes + axis];
                // A clamped value has no gradient.
                doutputs[axes + axis] = match log_std == clamped(log_std) {
                    true => dmean * self.deviations[at] * self.noise[at] - weight,
                    false => 0.0,
                };
            }
        }
    }
}

fn clamped(log_std: f32) -> f32 {
    log_std.clamp(LOG_STD_BOUNDS[0], LOG_STD_BOUNDS[1])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gradients_are_differences() {
        let outputs = [0.3, -0.4, -0.5, 0.2, 0.1, 0.6, -1.0, -0.2];
        let (weight, dactions) = (0.7, [0.5, -1.0, 2.0, 0.25]);
        let loss = |outputs: &[f32]| {
            let mut squashed = Squashed::default();
            squashed.sample(Isa::best(), outputs, 2, &mut Random::new(3));
            let logs: f32 = squashed.log_probabilities.iter().sum();
            weight * logs + squashed.actions.iter().zip(dactions).map(|(a, d)| a * d).sum::<f32>()
        };
        let mut squashed = Squashed::default();
        squashed.sample(Isa::best(), &outputs, 2, &mut Random::new(3));
        squashed.backward(&outputs, weight, &dactions);
        for at in 0..outputs.len() {
            let moved = |by: f32| {
                let mut outputs = outputs;
                outputs[at] += by;
                loss(&outputs)
            };
            let difference = (moved(1.0 / 128.0) - moved(-1.0 / 128.0)) * 64.0;
            let gradient = squashed.doutputs[at];
            assert!((gradient - difference).abs() < 5e-3, "{at}: {gradient} {difference}");
        }
    }

    #[test]
    fn densities_are_those_of_the_inverse() {
        let mut squashed = Squashed::default();
        squashed.sample(Isa::best(), &[0.2, -0.7], 1, &mut Random::new(1));
        let (action, deviation) = (f64::from(squashed.actions[0]), (-0.7f64).exp());
        let z = (action.atanh() - 0.2) / deviation;
        let exact = -0.5 * z * z + 0.7 - f64::from(HALF_LOG_TAU) - (1.0 - action * action).ln();
        assert!((f64::from(squashed.log_probabilities[0]) - exact).abs() < 1e-4);
    }
}
