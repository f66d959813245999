//! A layer of the encoder.

use burn::module::Module;
use burn::nn::{Dropout, DropoutConfig, LayerNorm, LayerNormConfig, Linear, LinearConfig};
use burn::tensor::activation::{relu, softmax};
use burn::tensor::{Device, Tensor};

/// A layer of a transformer encoder (Vaswani et al., Attention is all you need, 2017): attention and two linear maps, each with a
/// residual connection and a normalisation after it.
#[derive(Module, Debug)]
pub(super) struct EncoderLayer {
    query: Linear,
    key: Linear,
    value: Linear,
    output: Linear,
    attention_norm: LayerNorm,
    inner: Linear,
    outer: Linear,
    norm: LayerNorm,
    dropout: Dropout,
    #[module(skip)]
    heads: usize,
}

/// Query, key and value of tokens, each `[batch, tokens, features]`.
pub(super) struct Projected {
    pub query: Tensor<3>,
    pub key: Tensor<3>,
    pub value: Tensor<3>,
}

impl EncoderLayer {
    /// Returns a layer with initial weights, for tokens of `dims` features.
    pub fn new(dims: usize, hidden: usize, heads: usize, dropout: f64, device: &Device) -> Self {
        let linear = |inputs: usize, outputs: usize| LinearConfig::new(inputs, outputs).init(device);
        let norm = || LayerNormConfig::new(dims).init(device);
        Self {
            query: linear(dims, dims),
            key: linear(dims, dims),
            value: linear(dims, dims),
            output: linear(dims, dims),
            attention_norm: norm(),
            inner: linear(dims, hidden),
            outer: linear(hidden, dims),
            norm: norm(),
            dropout: DropoutConfig::new(dropout).init(),
            heads,
        }
    }

    /// Returns queries, keys and values of tokens.
    pub fn project(&self, tokens: Tensor<3>) -> Projected {
        Projected {
            query: self.query.forward(tokens.clone()),
            key: self.key.forward(tokens.clone()),
            value: self.value.forward(tokens),
        }
    }

    /// Returns the outputs of `tokens`, whose queries attend to the given keys and values.
    pub fn attend(&self, tokens: Tensor<3>, projected: Projected) -> Tensor<3> {
        let [batch, count, dims] = tokens.dims();
        let Projected { query, key, value } = projected;
        let (query, key, value) = (self.split(query), self.split(key), self.split(value));
        let scores = query.matmul(key.swap_dims(2, 3)) / ((dims / self.heads) as f64).sqrt();
        let weights = self.dropout.forward(softmax(scores, 3));
        let received = weights.matmul(value).swap_dims(1, 2).reshape([batch, count, dims]);
        let received = self.dropout.forward(self.output.forward(received));
        let tokens = self.attention_norm.forward(tokens + received);
        let mapped = self.dropout.forward(relu(self.inner.forward(tokens.clone())));
        self.norm.forward(tokens + self.dropout.forward(self.outer.forward(mapped)))
    }

    /// Returns the outputs of all tokens of sequences.
    pub fn forward(&self, tokens: Tensor<3>) -> Tensor<3> {
        let projected = self.project(tokens.clone());
        self.attend(tokens, projected)
    }

    /// Returns the output `[batch, 1, features]` of the last token of sequences.
    pub fn last(&self, tokens: Tensor<3>) -> Tensor<3> {
        let [_, count, _] = tokens.dims();
        let last = tokens.clone().narrow(1, count - 1, 1);
        let projected = Projected {
            query: self.query.forward(last.clone()),
            key: self.key.forward(tokens.clone()),
            value: self.value.forward(tokens),
        };
        self.attend(last, projected)
    }

    /// Splits features `[batch, tokens, heads * depth]` into `[batch, heads, tokens, depth]`.
    fn split(&self, features: Tensor<3>) -> Tensor<4> {
        let [batch, tokens, dims] = features.dims();
        features.reshape([batch, tokens, self.heads, dims / self.heads]).swap_dims(1, 2)
    }
}
