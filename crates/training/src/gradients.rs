//! Gradients of a network: their norm, sums, and form as bytes for other processes.

use burn::optim::GradientsParams;
use burn::tensor::{Device, ElementConversion, Gradients, Tensor, TensorData};
use opendr_engine::Result;

use crate::payload::{floats, take};
use crate::traversal::{AnyModule, FloatParam};

/// Gradients of the trained parameters of a network, in their order, each `[values]`; `None` where the loss does not depend on the
/// parameter.
#[derive(Default)]
pub struct NetworkGradients(Vec<Option<Tensor<1>>>);

impl NetworkGradients {
    /// Returns the gradients of a backward pass.
    pub fn new(network: &dyn AnyModule, mut gradients: Gradients) -> Self {
        let mut all = Vec::new();
        each_trained(network, &mut |param| all.push(param.take_gradient(&mut gradients)));
        Self(all)
    }

    /// Adds the gradients of another batch; the sum of none is [`Self::default`].
    pub fn add(&mut self, other: Self) {
        if self.0.is_empty() {
            self.0 = other.0;
            return;
        }
        for (sum, gradient) in self.0.iter_mut().zip(other.0) {
            *sum = match (sum.take(), gradient) {
                (Some(sum), Some(gradient)) => Some(sum + gradient),
                (sum, gradient) => sum.or(gradient),
            };
        }
    }

    /// Returns the Euclidean norm of all gradients together.
    pub fn norm(&self) -> f64 {
        let squares = self.0.iter().flatten().map(|gradient| gradient.clone().square().sum());
        let square = squares.reduce(|sum, square| sum + square);
        square.map_or(0.0, |square| square.into_scalar::<f32>().elem::<f64>().sqrt())
    }

    /// Multiplies all gradients by `factor`.
    pub fn scale(&mut self, factor: f64) {
        for gradient in &mut self.0 {
            *gradient = gradient.take().map(|gradient| gradient * factor);
        }
    }

    /// Returns the gradients for an optimiser.
    pub fn into_params(self, network: &dyn AnyModule) -> GradientsParams {
        let (mut params, mut gradients) = (GradientsParams::new(), self.0.into_iter());
        each_trained(network, &mut |param| {
            if let Some(gradient) = gradients.next().flatten() {
                param.register_gradient(gradient, &mut params);
            }
        });
        params
    }

    /// Appends the gradients to `bytes`.
    pub fn write(self, bytes: &mut Vec<u8>) {
        for gradient in self.0 {
            bytes.push(u8::from(gradient.is_some()));
            if let Some(gradient) = gradient {
                bytes.extend(gradient.into_data().iter::<f32>().flat_map(f32::to_le_bytes));
            }
        }
    }

    /// Reads gradients on `device` from the beginning of `bytes`, which are moved past them.
    ///
    /// # Errors
    /// `Format` where the bytes are not those of gradients of this network.
    pub fn read(network: &dyn AnyModule, device: &Device, bytes: &mut &[u8]) -> Result<Self> {
        let mut read = |size| -> Result<Option<Tensor<1>>> {
            if take(bytes)? == [0] {
                return Ok(None);
            }
            Ok(Some(Tensor::from_data(TensorData::new(floats(bytes, size)?, [size]), device)))
        };
        let mut all = Ok(Vec::new());
        each_trained(network, &mut |param| {
            if let Ok(gradients) = &mut all {
                match read(param.shape().iter().product()) {
                    Ok(gradient) => gradients.push(gradient),
                    Err(error) => all = Err(error),
                }
            }
        });
        all.map(Self)
    }
}

fn each_trained(network: &dyn AnyModule, each: &mut dyn FnMut(&dyn FloatParam)) {
    network.visit_each(&mut |param: &dyn FloatParam| {
        if param.is_trained() {
            each(param);
        }
    });
}
