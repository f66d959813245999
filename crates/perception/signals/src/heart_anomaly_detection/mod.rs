//! Detection of anomalies in heart signals.

mod attention_neural_bag_of_feature;
mod beat_stream;
mod gated_recurrent_unit;
#[cfg(feature = "training")]
mod halvings;
mod heart_learner;

pub use attention_neural_bag_of_feature::{
    AttentionNeuralBagOfFeature, AttentionNeuralBagOfFeatureKind, AttentionNeuralBagOfFeatureParams,
    AttentionType, QuantizationType,
};
pub use beat_stream::BeatStream;
pub use gated_recurrent_unit::{GatedRecurrentUnit, GatedRecurrentUnitKind, GatedRecurrentUnitParams};
pub use heart_learner::{HeartKind, HeartLearner, HeartParams};
#[cfg(feature = "training")]
pub use {
    attention_neural_bag_of_feature::AttentionNeuralBagOfFeatureFitParams,
    gated_recurrent_unit::GatedRecurrentUnitFitParams,
    heart_learner::{HeartSizes, TrainableHeart},
};
