//! Attention over a series of code words.

use burn::module::{Initializer, Module, Param};
use burn::nn::{Dropout, DropoutConfig, Linear, LinearConfig};
use burn::tensor::activation::{sigmoid, softmax};
use burn::tensor::{Device, Tensor};

use super::AttentionType;

/// Features that likeness is computed of.
const HIDDEN: usize = 128;
/// Share of the attention that is left out at random in training.
const DROPOUT: f64 = 0.2;

/// `[batch, steps, words]` to the same; a learnt share of it is attended, the rest is let through.
#[derive(Module, Debug)]
pub struct Attention {
    share: Param<Tensor<1>>,
    weights: Weights,
    /// Whether it is over code words: then they and the steps change places.
    spatial: bool,
}

#[derive(Module, Debug)]
enum Weights {
    /// How much each attends to each other.
    Matrix(Param<Tensor<2>>),
    /// What each asks and what it offers.
    Likeness(Likeness),
    /// What code words ask and steps offer.
    Both(Likeness),
}

#[derive(Module, Debug)]
struct Likeness {
    query: Linear,
    key: Linear,
    dropout: Dropout,
}

impl Attention {
    /// With weights as training begins with.
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

    /// The series attended.
    pub fn forward(&self, series: Tensor<3>) -> Tensor<3> {
        // Rows are what attends: code words, or instants.
        let rows = if self.spatial { series.swap_dims(1, 2) } else { series };
        let attended = match &self.weights {
            Weights::Matrix(weights) => {
                let size = rows.dims()[1];
                let itself = Tensor::<2>::eye(size, &rows.device());
                let weights = weights.val();
                // How much each attends to itself is fixed.
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
    /// Of each row of `queries` and each of `keys`, `[batch, queries, keys]`.
    fn of(&self, queries: Tensor<3>, keys: Tensor<3>) -> Tensor<3> {
        let keys = self.key.forward(keys).swap_dims(1, 2);
        self.query.forward(queries).matmul(keys) / (HIDDEN as f64).sqrt()
    }
}
