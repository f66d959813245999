//! Test that a trainable learner overfits one batch.

use burn::module::Module;
use burn::optim::{AdamConfig, GradientsParams};
use burn::tensor::Device;
use opendr_datasets::augment::{Augment, OtherSamples};
use opendr_datasets::loader::Collate;
use opendr_engine::Random;
use opendr_engine::dataset::Sample;
use opendr_training::Objective;

/// Returns the loss of `samples`, one batch, before and after 300 training steps on it.
pub fn losses_on_one_batch<O: Objective>(
    objective: &O,
    network: impl FnOnce(&Device) -> O::Network,
    samples: Vec<Sample>,
    lr: f64,
) -> [f32; 2] {
    let device = Device::flex();
    device.seed(1);
    let mut network = network(&device).to_device(&device.clone().autodiff()).train();
    let device = device.autodiff();
    let (collate, pipeline) = (objective.collate().unwrap(), objective.pipeline().unwrap());
    let mut batch = collate.start(samples.len());
    for mut sample in samples {
        pipeline.apply(&mut sample, &mut Random::new(0), &OtherSamples::none()).unwrap();
        collate.add(&mut batch, sample).unwrap();
    }
    let mut optimizer = AdamConfig::new().init();
    let mut losses = Vec::new();
    for _ in 0..=300 {
        let loss = objective.loss(&network, &batch, &device).unwrap().total;
        losses.push(loss.clone().into_scalar::<f32>());
        let gradients = GradientsParams::from_grads(loss.backward(), &network);
        network = optimizer.step(lr, network, gradients);
    }
    [losses[0], losses[300]]
}
