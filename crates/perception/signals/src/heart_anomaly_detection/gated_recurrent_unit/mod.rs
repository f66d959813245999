//! Gated recurrent unit (GRU) after strided convolutions, with a classifier on its last state.
//!
//! After Cho et al., Learning Phrase Representations using RNN Encoder-Decoder for Statistical Machine Translation, 2014, and
//! OpenDR's learner of this name. In place of its fifteen residual blocks there are as many convolutions of stride two as leave
//! at most 64 steps: a thirtieth of the arithmetic for a heart beat, and training on a CPU takes minutes. For single beats or
//! short recordings of any number of leads.

#[cfg(feature = "training")]
mod network;
#[cfg(feature = "training")]
mod training;

use opendr_engine::Task;
use opendr_engine::learner::Spec;
use opendr_engine::params::Params;

use crate::heart_anomaly_detection::heart_learner::{HeartKind, HeartLearner, HeartParams, TEST_MODE};
#[cfg(feature = "training")]
pub use training::GatedRecurrentUnitFitParams;

/// Parameters of [`GatedRecurrentUnit`]. The sizes apply to the network that is trained; a loaded model has its own and refuses
/// other values.
#[derive(Debug, Clone, Params)]
pub struct GatedRecurrentUnitParams {
    /// Parameters common to all learners of heart signals.
    #[param(flatten)]
    pub heart: HeartParams,
    /// Number of features of the recurrent unit's state.
    #[param(default = 512, range = 1..=4096)]
    pub recurrent_unit: usize,
}

/// A loaded network.
pub type GatedRecurrentUnit = HeartLearner<GatedRecurrentUnitKind>;

/// Network kind of [`GatedRecurrentUnit`].
#[derive(Debug)]
pub struct GatedRecurrentUnitKind;

impl HeartKind for GatedRecurrentUnitKind {
    const SPEC: Spec = Spec::new("gated_recurrent_unit", Task::HeartAnomalyDetection)
        .class("GatedRecurrentUnitLearner")
        .about("A gated recurrent unit classifies heart beats as normal or abnormal.")
        .without_effect(TEST_MODE);
    type Params = GatedRecurrentUnitParams;

    fn heart(params: &GatedRecurrentUnitParams) -> &HeartParams {
        &params.heart
    }
}
