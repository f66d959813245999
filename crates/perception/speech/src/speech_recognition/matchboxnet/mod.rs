//! MatchboxNet: time-channel separable convolutions on cepstra; small and fast.
//!
//! Majumdar and Ginsburg, MatchboxNet: 1D Time-Channel Separable Convolutional Neural Network Architecture for Speech Commands
//! Recognition, Interspeech 2020. For a few dozen words, spoken one at a time. A stream of audio yields a prediction twice per
//! second, each for the last second.

#[cfg(feature = "training")]
mod network;
#[cfg(feature = "training")]
mod training;

use opendr_engine::Task;
use opendr_engine::learner::Spec;
use opendr_engine::params::Params;

use crate::speech_recognition::word_learner::{WordKind, WordLearner, WordParams};
#[cfg(feature = "training")]
pub use training::MatchboxNetFitParams;

/// Parameters of [`MatchboxNet`]. The sizes apply to the network that is trained; a loaded model has its own.
#[derive(Debug, Clone, Params)]
pub struct MatchboxNetParams {
    /// Number of residual blocks (B in the paper).
    #[param(default = 3, range = 1..=64)]
    pub number_of_blocks: usize,
    /// Number of convolutions per block (R in the paper).
    #[param(default = 1, range = 1..=64)]
    pub number_of_subblocks: usize,
    /// Number of channels of the blocks (C in the paper).
    #[param(default = 64, range = 1..=4096)]
    pub number_of_channels: usize,
    /// Parameters common to all keyword spotting learners.
    #[param(flatten)]
    pub words: WordParams,
}

/// A loaded MatchboxNet.
pub type MatchboxNet = WordLearner<MatchboxNetKind>;

/// Network kind of [`MatchboxNet`].
#[derive(Debug)]
pub struct MatchboxNetKind;

impl WordKind for MatchboxNetKind {
    const SPEC: Spec = Spec::new("matchboxnet", Task::SpeechRecognition)
        .class("MatchboxNetLearner")
        .about("MatchboxNet classifies spoken words; small and fast.");
    const COEFFICIENTS: usize = 64;
    type Params = MatchboxNetParams;

    fn words(params: &MatchboxNetParams) -> &WordParams {
        &params.words
    }
}
