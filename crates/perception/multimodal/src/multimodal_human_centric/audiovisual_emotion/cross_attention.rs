//! What one series attends of another.

use burn::module::Module;
use burn::nn::{Linear, LinearConfig};
use burn::tensor::activation::softmax;
use burn::tensor::{Device, Tensor};

/// From a series that asks, `[batch, asking channels, instants]`, and one that is asked, `[batch, asked channels, others]`.
#[derive(Module, Debug)]
pub(super) struct CrossAttention {
    query: Linear,
    key: Linear,
    value: Linear,
}

/// Features that likeness is computed of.
const FEATURES: usize = 64;

impl CrossAttention {
    /// With weights as training begins with.
    pub fn new([asking, asked]: [usize; 2], device: &Device) -> Self {
        Self {
            query: LinearConfig::new(asking, FEATURES).init(device),
            key: LinearConfig::new(asked, FEATURES).init(device),
            value: LinearConfig::new(asked, asking).init(device),
        }
    }

    /// How much each instant of `asked` counts for those of `asking`, `[batch, 1, others]`; 1 on average.
    pub fn importance(&self, asking: Tensor<3>, asked: Tensor<3>) -> Tensor<3> {
        let [.., others] = asked.dims();
        self.weights(asking, asked).mean_dim(1) * others as f64
    }

    /// What `asking` attends of `asked`, `[batch, asking channels, instants]`.
    pub fn attended(&self, asking: Tensor<3>, asked: Tensor<3>) -> Tensor<3> {
        let values = self.value.forward(asked.clone().swap_dims(1, 2));
        self.weights(asking, asked).matmul(values).swap_dims(1, 2)
    }

    /// `[batch, instants, others]`, each row of sum one.
    fn weights(&self, asking: Tensor<3>, asked: Tensor<3>) -> Tensor<3> {
        let query = self.query.forward(asking.swap_dims(1, 2));
        let key = self.key.forward(asked.swap_dims(1, 2));
        softmax(query.matmul(key.swap_dims(1, 2)) / (FEATURES as f64).sqrt(), 2)
    }
}
