//! Training on augmentations of the demonstration.

use opendr_engine::{Error, Random, Result};
use opendr_kernels::{Adam, AdamOptions, Compute, Tape, WeightDecay};

use super::augmentation::augment;
use super::cutout::Cutout;
use super::example::GraspExample;
use super::network::{GraspNetwork, OUTPUTS, SQUARE, normalise};
use super::objective::loss;

/// A training from one demonstration.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GraspTraining {
    /// Learning rate of Adam at the start; it falls to 0.
    pub rate: f32,
    /// Number of steps.
    pub steps: usize,
    /// Augmented images of a step.
    pub batch: usize,
    /// Number of threads.
    pub threads: usize,
    /// Seed of initialisation and augmentations.
    pub seed: u64,
}

/// Trains a network on augmentations of a demonstration. `observer` receives the number of steps and the loss of the last; it returns
/// whether to stop.
///
/// # Errors
/// `InvalidInput` for a demonstration whose object does not differ from its background, `Internal` if the training diverges.
pub fn train_from_demonstration(
    example: &GraspExample,
    training: &GraspTraining,
    observer: &mut dyn FnMut(usize, f32) -> bool,
) -> Result<GraspNetwork> {
    let GraspTraining { rate, steps, batch, threads, seed } = *training;
    let cutout = Cutout::new(example)?;
    let mut random = Random::from_key([seed, 0x9a5b]);
    let GraspNetwork { network, mut parameters } = GraspNetwork::random(&mut random)?;
    let compute = Compute::with_threads(threads);
    let options = AdamOptions { weight_decay: WeightDecay::Decoupled(1e-4), ..AdamOptions::default() };
    let mut adam = Adam::new(parameters.len(), options);
    let (mut gradients, mut tape) = (vec![0.0; parameters.len()], Tape::default());
    let (mut input, mut doutput) = (vec![0.0; batch * 3 * SQUARE], vec![0.0; batch * OUTPUTS]);
    let mut jaws = vec![None; batch];
    for step in 0..steps {
        for (sample, (planes, jaws)) in input.chunks_exact_mut(3 * SQUARE).zip(&mut jaws).enumerate() {
            let mut random = Random::from_key([seed, step as u64, sample as u64]);
            *jaws = augment(&cutout, &mut random, planes);
            normalise(planes);
        }
        let output = network.forward(&compute, &parameters, &input, &mut tape);
        let samples = output.chunks_exact(OUTPUTS).zip(doutput.chunks_exact_mut(OUTPUTS)).zip(&jaws);
        let sum: f32 = samples
            .map(|((output, doutput), jaws)| loss(output, jaws.as_ref(), 1.0 / batch as f32, doutput))
            .sum();
        if !sum.is_finite() {
            return Err(Error::internal(format!(
                "the loss of step {step} is {sum}: the training diverged; lower lr"
            )));
        }
        gradients.fill(0.0);
        network.backward(&compute, &parameters, &doutput, &mut tape, Some(&mut gradients), false);
        let done = step as f32 / steps as f32;
        let decayed = 0.5 * rate * (1.0 + (std::f32::consts::PI * done).cos());
        adam.step(&compute, decayed, &mut parameters, &gradients);
        if observer(step + 1, sum) {
            break;
        }
    }
    Ok(GraspNetwork { network, parameters })
}
