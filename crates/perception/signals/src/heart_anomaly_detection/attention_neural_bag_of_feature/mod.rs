//! Convolutions that shorten a heart signal, a bag of learnt features over what they leave, with attention.
//!
//! Passalis et al., Temporal Bag-of-Features Learning for Predicting Mid Price Movements, 2019; Tran et al.,
//! Attention-based Neural Bag-of-Features Learning for Sequence Data, 2020; Chumachenko et al., Self-attention Neural
//! Bag-of-Features, 2022. As in [`GatedRecurrentUnit`](crate::heart_anomaly_detection::GatedRecurrentUnit), few
//! convolutions stand for OpenDR's fifteen residual blocks. OpenDR computes no attention, though its learner makes
//! the weights for it; here it is applied.

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
    /// What is put into the bag.
    pub enum QuantizationType {
        /// The whole series.
        Nbof = "nbof",
        /// The whole series and, apart, its second half.
        Tnbof = "tnbof",
    }
}

opendr_engine::choices! {
    /// Over what attention is spread.
    pub enum AttentionType {
        /// Over code words, by a learnt matrix.
        Spatial = "spatial",
        /// Over time, by a learnt matrix.
        Temporal = "temporal",
        /// Over code words, by their likeness.
        Spatialsa = "spatialsa",
        /// Over time, by the likeness of instants.
        Temporalsa = "temporalsa",
        /// Over both at once.
        Spatiotemporal = "spatiotemporal",
    }
}

/// What a user may set. Sizes are those of the network that is trained; a loaded model has its own, and one that is
/// given and differs is refused.
#[derive(Debug, Clone, Params)]
pub struct AttentionNeuralBagOfFeatureParams {
    /// What all learners of heart signals have.
    #[param(flatten)]
    pub heart: HeartParams,
    /// Learnt features.
    #[param(default = 256, range = 1..=4096)]
    pub n_codeword: usize,
    /// What is put into the bag.
    #[param(default = QuantizationType::Nbof)]
    pub quantization_type: QuantizationType,
    /// Over what attention is spread.
    #[param(default = AttentionType::Spatial)]
    pub attention_type: AttentionType,
}

/// A loaded network.
pub type AttentionNeuralBagOfFeature = HeartLearner<AttentionNeuralBagOfFeatureKind>;

/// Which network it is.
#[derive(Debug)]
pub struct AttentionNeuralBagOfFeatureKind;

impl HeartKind for AttentionNeuralBagOfFeatureKind {
    const SPEC: Spec = Spec::new("attention_neural_bag_of_feature", Task::HeartAnomalyDetection)
        .class("AttentionNeuralBagOfFeatureLearner")
        .about("A bag of learnt features with attention tells abnormal heart beats from normal ones.")
        .without_effect(TEST_MODE);
    type Params = AttentionNeuralBagOfFeatureParams;

    fn heart(params: &AttentionNeuralBagOfFeatureParams) -> &HeartParams {
        &params.heart
    }
}
