//! MatchboxNet: convolutions that are separable in time and channel, over cepstra; small and quick.
//!
//! Majumdar and Ginsburg, MatchboxNet: 1D Time-Channel Separable Convolutional Neural Network Architecture for Speech
//! Commands Recognition, Interspeech 2020. Take it for a few dozen words, spoken one at a time. A stream
//! of sound is answered twice a second, each time for the second before.

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

/// What a user may set. Sizes are those of the network that is trained; a loaded model has its own.
#[derive(Debug, Clone, Params)]
pub struct MatchboxNetParams {
    /// Blocks with a way past them (B in the paper).
    #[param(default = 3, range = 1..=64)]
    pub number_of_blocks: usize,
    /// Convolutions in a block (R in the paper).
    #[param(default = 1, range = 1..=64)]
    pub number_of_subblocks: usize,
    /// Channels of the blocks (C in the paper).
    #[param(default = 64, range = 1..=4096)]
    pub number_of_channels: usize,
    /// What all learners of words have.
    #[param(flatten)]
    pub words: WordParams,
}

/// A loaded MatchboxNet.
pub type MatchboxNet = WordLearner<MatchboxNetKind>;

/// Which network it is.
#[derive(Debug)]
pub struct MatchboxNetKind;

impl WordKind for MatchboxNetKind {
    const SPEC: Spec = Spec::new("matchboxnet", Task::SpeechRecognition)
        .class("MatchboxNetLearner")
        .about("MatchboxNet tells which of a few words was spoken; small and quick.");
    const COEFFICIENTS: usize = 64;
    type Params = MatchboxNetParams;

    fn words(params: &MatchboxNetParams) -> &WordParams {
        &params.words
    }
}
