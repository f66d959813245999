//! Attention-based neural bag of features: strided convolutions, a codebook over their outputs, attention.
//!
//! Passalis et al., Temporal Bag-of-Features Learning for Predicting Mid Price Movements, 2019; Tran et al., Attention-based
//! Neural Bag-of-Features Learning for Sequence Data, 2020; Chumachenko et al., Self-attention Neural Bag-of-Features, 2022. As
//! in [`GatedRecurrentUnit`](crate::heart_anomaly_detection::GatedRecurrentUnit), a few convolutions replace OpenDR's fifteen
//! residual blocks. OpenDR's learner creates attention weights but does not apply them; here attention is applied.

#[cfg(feature = "training")]
mod attention;
#[cfg(feature = "training")]
mod network;
#[cfg(feature = "training")]
mod training;

use opendr_engine::Task;
use opendr_engine::learner::Spec;
use opendr_engine::params::Params;

use crate::heart_anomaly_detection::heart_learner::{HeartKind, HeartLearner, HeartParams, TEST_MODE};
#[cfg(feature = "training")]
pub use training::AttentionNeuralBagOfFeatureFitParams;

opendr_engine::choices! {
    /// Input of the bag of features.
    pub enum QuantizationType {
        /// The whole sequence.
        Nbof = "nbof",
        /// The whole sequence and, separately, its second half.
        Tnbof = "tnbof",
    }
}

opendr_engine::choices! {
    /// Axis and kind of the attention.
    pub enum AttentionType {
        /// Over codewords, with a learnt matrix.
        Spatial = "spatial",
        /// Over time, with a learnt matrix.
        Temporal = "temporal",
        /// Over codewords, with self-attention.
        Spatialsa = "spatialsa",
        /// Over time, with self-attention.
        Temporalsa = "temporalsa",
        /// Over both at once.
        Spatiotemporal = "spatiotemporal",
    }
}

/// Parameters of [`AttentionNeuralBagOfFeature`]. The sizes apply to the network that is trained; a loaded model has its own
/// and refuses other values.
#[derive(Debug, Clone, Params)]
pub struct AttentionNeuralBagOfFeatureParams {
    /// Parameters common to all learners of heart signals.
    #[param(flatten)]
    pub heart: HeartParams,
    /// Number of codewords.
    #[param(default = 256, range = 1..=4096)]
    pub n_codeword: usize,
    /// Input of the bag of features.
    #[param(default = QuantizationType::Nbof)]
    pub quantization_type: QuantizationType,
    /// Axis and kind of the attention.
    #[param(default = AttentionType::Spatial)]
    pub attention_type: AttentionType,
}

/// A loaded network.
pub type AttentionNeuralBagOfFeature = HeartLearner<AttentionNeuralBagOfFeatureKind>;

/// Network kind of [`AttentionNeuralBagOfFeature`].
#[derive(Debug)]
pub struct AttentionNeuralBagOfFeatureKind;

impl HeartKind for AttentionNeuralBagOfFeatureKind {
    const SPEC: Spec = Spec::new("attention_neural_bag_of_feature", Task::HeartAnomalyDetection)
        .class("AttentionNeuralBagOfFeatureLearner")
        .about("A neural bag of features with attention classifies heart beats as normal or abnormal.")
        .without_effect(TEST_MODE);
    type Params = AttentionNeuralBagOfFeatureParams;

    fn heart(params: &AttentionNeuralBagOfFeatureParams) -> &HeartParams {
        &params.heart
    }
}
