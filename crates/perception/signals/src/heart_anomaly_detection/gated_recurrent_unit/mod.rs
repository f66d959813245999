//! Convolutions that shorten a heart signal, a gated recurrent unit over what they leave, a classifier of its last state.
//!
//! After Cho et al., Learning Phrase Representations using RNN Encoder-Decoder for Statistical Machine Translation, 2014,
//! and OpenDR's learner of this name, whose fifteen residual blocks before the unit are here as many plain convolutions as
//! it takes to leave at most 64 steps: a thirtieth of the arithmetic for a heart beat, and the unit
//! learns in minutes on a processor. Take it for single beats or short recordings of any number of leads.

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

/// What a user may set. Sizes are those of the network that is trained; a loaded model has its own, and one that is
/// given and differs is refused.
#[derive(Debug, Clone, Params)]
pub struct GatedRecurrentUnitParams {
    /// What all learners of heart signals have.
    #[param(flatten)]
    pub heart: HeartParams,
    /// Features of the recurrent unit's state.
    #[param(default = 512, range = 1..=4096)]
    pub recurrent_unit: usize,
}

/// A loaded network.
pub type GatedRecurrentUnit = HeartLearner<GatedRecurrentUnitKind>;

/// Which network it is.
#[derive(Debug)]
pub struct GatedRecurrentUnitKind;

impl HeartKind for GatedRecurrentUnitKind {
    const SPEC: Spec = Spec::new("gated_recurrent_unit", Task::HeartAnomalyDetection)
        .class("GatedRecurrentUnitLearner")
        .about("A gated recurrent unit tells abnormal heart beats from normal ones.")
        .without_effect(TEST_MODE);
    type Params = GatedRecurrentUnitParams;

    fn heart(params: &GatedRecurrentUnitParams) -> &HeartParams {
        &params.heart
    }
}
