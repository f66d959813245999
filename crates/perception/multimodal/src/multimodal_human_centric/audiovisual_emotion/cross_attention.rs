//! Cross-attention between two sequences.

use burn::module::Module;
use burn::nn::{Linear, LinearConfig};
use burn::tensor::activation::softmax;
use burn::tensor::{Device, Tensor};

/// Cross-attention from a target, `[batch, target channels, steps]`, to a source, `[batch, source channels, source steps]`.
#[derive(Module, Debug)]
pub(super) struct CrossAttention {
    query: Linear,
    key: Linear,
    value: Linear,
}

/// Number of features of queries and keys.
const FEATURES: usize = 64;

impl CrossAttention {
    /// Creates the layer with initial weights.
    pub fn new([target, source]: [usize; 2], device: &Device) -> Self {
        Self {
            query: LinearConfig::new(target, FEATURES).init(device),
            key: LinearConfig::new(source, FEATURES).init(device),
            value: LinearConfig::new(source, target).init(device),
        }
    }

    /// Returns the weight of each step of `source` for `target`, `[batch, 1, source steps]`; 1 on average.
    pub fn importance(&self, target: Tensor<3>, source: Tensor<3>) -> Tensor<3> {
        let [.., others] = source.dims();
        self.weights(target, source).mean_dim(1) * others as f64
    }

    /// Returns the attended values of `source`, `[batch, target channels, steps]`.
    pub fn attended(&self, target: Tensor<3>, source: Tensor<3>) -> Tensor<3> {
        let values = self.value.forward(source.clone().swap_dims(1, 2));
        self.weights(target, source).matmul(values).swap_dims(1, 2)
    }

    /// Returns attention weights `[batch, steps, source steps]`; each row sums to one.
    fn weights(&self, target: Tensor<3>, source: Tensor<3>) -> Tensor<3> {
        let query = self.query.forward(target.swap_dims(1, 2));
        let key = self.key.forward(source.swap_dims(1, 2));
        softmax(query.matmul(key.swap_dims(1, 2)) / (FEATURES as f64).sqrt(), 2)
    }
}
