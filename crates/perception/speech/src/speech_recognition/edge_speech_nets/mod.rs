//! EdgeSpeechNets: small residual networks over cepstra, in four sizes.
//!
//! Lin, Chung and Wong, EdgeSpeechNets: Highly Efficient Deep Neural Networks for Speech Recognition on the Edge, 2018. Take
//! D, the quickest, for small processors, A for the best answers. A stream of sound is answered twice a second,
//! each time for the second before.

#[cfg(feature = "training")]
mod network;
#[cfg(feature = "training")]
mod training;

use opendr_engine::Task;
use opendr_engine::learner::Spec;
use opendr_engine::params::Params;

use crate::speech_recognition::word_learner::{WordKind, WordLearner, WordParams};
#[cfg(feature = "training")]
pub use training::EdgeSpeechNetsFitParams;

opendr_engine::choices! {
    /// Which of the paper's four networks.
    pub enum EdgeSpeechNet {
        /// Six blocks of 39 channels.
        A = "A",
        /// Six blocks of 30 channels.
        B = "B",
        /// Seven blocks of 24 channels.
        C = "C",
        /// Three blocks of 45 channels at half the resolution.
        D = "D",
    }
}

/// What a user may set.
#[derive(Debug, Clone, Params)]
pub struct EdgeSpeechNetsParams {
    /// Which network is trained; a loaded model has its own.
    #[param(default = EdgeSpeechNet::A)]
    pub architecture: EdgeSpeechNet,
    /// What all learners of words have.
    #[param(flatten)]
    pub words: WordParams,
}

/// A loaded EdgeSpeechNet.
pub type EdgeSpeechNets = WordLearner<EdgeSpeechNetsKind>;

/// Which network it is.
#[derive(Debug)]
pub struct EdgeSpeechNetsKind;

impl WordKind for EdgeSpeechNetsKind {
    const SPEC: Spec = Spec::new("edge_speech_nets", Task::SpeechRecognition)
        .class("EdgeSpeechNetsLearner")
        .about("EdgeSpeechNets tell which of a few words was spoken; in four sizes.");
    const COEFFICIENTS: usize = 24;
    type Params = EdgeSpeechNetsParams;

    fn words(params: &EdgeSpeechNetsParams) -> &WordParams {
        &params.words
    }
}
