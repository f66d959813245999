//! Supervised training of small networks.

use opendr_engine::{Random, Result};
use opendr_kernels::{Activation, Adam, AdamOptions, Compute, Initialisation, Network, Tape};

/// Features and targets of a training: rows of `inputs` and of `outputs` numbers; targets are probabilities.
pub(super) struct Samples<'a> {
    pub features: &'a [f32],
    pub targets: &'a [f32],
    pub inputs: usize,
    pub outputs: usize,
}

/// Settings of a training with Adam, whose learning rate decreases linearly to zero.
pub(super) struct Settings {
    pub hidden: usize,
    pub epochs: usize,
    pub batch: usize,
    pub learning_rate: f32,
    pub key: [u64; 2],
}

/// Trains a network with one hidden layer to logits of the targets, by the cross-entropy. Returns its parameters.
///
/// # Errors
/// None; the sizes are valid.
pub(super) fn train(samples: &Samples<'_>, settings: &Settings, compute: &Compute) -> Result<Vec<f32>> {
    let Samples { features: all, targets, inputs, outputs } = *samples;
    let Settings { hidden, epochs, batch, learning_rate, key } = *settings;
    let network = Network::dense(&[inputs, hidden, outputs], Activation::Relu)?;
    let mut random = Random::from_key(key);
    let mut parameters = vec![0.0; network.parameters()];
    network.initialise(Initialisation::Uniform, &mut random, &mut parameters);
    let mut adam = Adam::new(parameters.len(), AdamOptions::default());
    let (mut tape, mut gradients) = (Tape::default(), vec![0.0; parameters.len()]);
    let mut order: Vec<usize> = (0..targets.len() / outputs).collect();
    let (mut features, mut errors) = (Vec::new(), Vec::new());
    let total = (epochs * order.len().div_ceil(batch)) as f32;
    let mut step = 0.0;
    for _ in 0..epochs {
        random.shuffle(&mut order);
        for rows in order.chunks(batch) {
            features.clear();
            rows.iter().for_each(|row| features.extend_from_slice(&all[row * inputs..][..inputs]));
            let logits = network.forward(compute, &parameters, &features, &mut tape);
            errors.clear();
            for (logits, row) in logits.chunks_exact(outputs).zip(rows) {
                let targets = &targets[row * outputs..][..outputs];
                // The gradient of the cross-entropy.
                let error = |(logit, target): (&f32, &f32)| 1.0 / (1.0 + (-logit).exp()) - target;
                errors.extend(logits.iter().zip(targets).map(error).map(|error| error / rows.len() as f32));
            }
            gradients.fill(0.0);
            network.backward(compute, &parameters, &errors, &mut tape, Some(&mut gradients), false);
            adam.step(compute, learning_rate * (1.0 - step / total), &mut parameters, &gradients);
            step += 1.0;
        }
    }
    Ok(parameters)
}
