//! Attention over a sequence of codewords.

use burn::module::{Initializer, Module, Param};
use burn::nn::{Dropout, DropoutConfig, Linear, LinearConfig};
use burn::tensor::activation::{sigmoid, softmax};
use burn::tensor::{Device, Tensor};

use super::AttentionType;

/// Number of features of queries and keys.
const HIDDEN: usize = 128;
/// Dropout probability of the attention weights.
const DROPOUT: f64 = 0.2;

/// Attention on `[batch, steps, words]`; a learnt share of the output is attended, the rest is the input.
#[derive(Module, Debug)]
pub struct Attention {
    share: Param<Tensor<1>>,
    weights: Weights,
    /// Whether attention is over codewords; then they and the steps are transposed.
    spatial: bool,
}

#[derive(Module, Debug)]
enum Weights {
    /// A learnt matrix of attention weights.
    Matrix(Param<Tensor<2>>),
    /// Weights from queries and keys of the same axis.
    Likeness(Likeness),
    /// Weights from queries of codewords and keys of steps.
    Both(Likeness),
}

#[derive(Module, Debug)]
struct Likeness {
    query: Linear,
    key: Linear,
    dropout: Dropout,
}

impl Attention {
    /// Creates the layer with initial weights.
    pub fn new(kind: AttentionType, [steps, words]: [usize; 2], device: &Device) -> Self {
        let likeness = |query: usize, key: usize| Likeness {
            query: LinearConfig::new(query, HIDDEN).init(device),
            key: LinearConfig::new(key, HIDDEN).init(device),
            dropout: DropoutConfig::new(DROPOUT).init(),
        };
        let matrix = |size: usize| {
            let same = Initializer::Constant { value: 1.0 / size as f64 };
            Weights::Matrix(same.init([size, size], device))
        };
        let weights = match kind {
            AttentionType::Spatial => matrix(words),
            AttentionType::Temporal => matrix(steps),
            AttentionType::Spatialsa => Weights::Likeness(likeness(steps, steps)),
            AttentionType::Temporalsa => Weights::Likeness(likeness(words, words)),
            AttentionType::Spatiotemporal => Weights::Both(likeness(steps, words)),
        };
        let spatial = !matches!(kind, AttentionType::Temporal | AttentionType::Temporalsa);
        Self { share: Initializer::Constant { value: 0.5 }.init([1], device), weights, spatial }
    }

    /// Applies attention to sequences of codewords `[batch, steps, words]`; the shape stays.
    pub fn forward(&self, series: Tensor<3>) -> Tensor<3> {
        // Rows attend: codewords or steps.
        let rows = if self.spatial { series.swap_dims(1, 2) } else { series };
        let attended = match &self.weights {
            Weights::Matrix(weights) => {
                let size = rows.dims()[1];
                let itself = Tensor::<2>::eye(size, &rows.device());
                let weights = weights.val();
                // The weight of each row for itself is fixed.
                let weights = weights.clone() - weights * itself.clone() + itself / size as f64;
                let mask = softmax(weights.unsqueeze::<3>().matmul(rows.clone()), 1);
                rows.clone() * mask
            }
            Weights::Likeness(likeness) => {
                let mask = softmax(likeness.of(rows.clone(), rows.clone()), 2);
                likeness.dropout.forward(mask).matmul(rows.clone())
            }
            Weights::Both(likeness) => {
                let mask = sigmoid(likeness.of(rows.clone(), rows.clone().swap_dims(1, 2)));
                rows.clone() * mask
            }
        };
        let share = self.share.val().clamp(0.0, 1.0).reshape([1, 1, 1]);
        let rows = attended.clone() + (rows - attended) * share;
        if self.spatial { rows.swap_dims(1, 2) } else { rows }
    }
}

impl Likeness {
    /// Returns the weights of each row of `queries` for each of `keys`, `[batch, queries, keys]`.
    fn of(&self, queries: Tensor<3>, keys: Tensor<3>) -> Tensor<3> {
        let keys = self.key.forward(keys).swap_dims(1, 2);
        self.query.forward(queries).matmul(keys) / (HIDDEN as f64).sqrt()
    }
}
