//! Moving average of a network's weights.

use std::vec::IntoIter;

use burn::tensor::Tensor;

use crate::traversal::{AnyModule, Change, FloatParam};

/// Moves the weights of a network towards those of another of the same form, `w = decay * w + (1 - decay) * other`, an exponential
/// moving average (Polyak and Juditsky 1992), including the statistics of batch normalisation. Both are in their form for inference.
pub struct Towards {
    latest: IntoIter<Tensor<1>>,
    decay: f64,
}

impl Towards {
    /// Creates the change towards `latest` after step `step`, from 1; the decay is smaller in the first steps.
    pub fn new(latest: &dyn AnyModule, decay: f64, step: u64) -> Self {
        let mut all = Vec::new();
        latest.visit_each(&mut |param: &dyn FloatParam| all.push(param.value()));
        let decay = decay.min((1.0 + step as f64) / (10.0 + step as f64));
        Self { latest: all.into_iter(), decay }
    }
}

impl Change for Towards {
    fn float(&mut self, param: &dyn FloatParam) -> Option<Tensor<1>> {
        let latest = self.latest.next()?;
        Some(param.value() * self.decay + latest * (1.0 - self.decay))
    }
}
