//! EdgeSpeechNets: small residual networks on cepstra, in four sizes.
//!
//! Lin, Chung and Wong, EdgeSpeechNets: Highly Efficient Deep Neural Networks for Speech Recognition on the Edge, 2018. D is
//! the fastest, for small CPUs; A is the most accurate. A stream of audio yields a prediction twice per second, each for the
//! last second.

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
    /// Network of the paper.
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

/// Parameters of [`EdgeSpeechNets`].
#[derive(Debug, Clone, Params)]
pub struct EdgeSpeechNetsParams {
    /// Network that is trained; a loaded model has its own.
    #[param(default = EdgeSpeechNet::A)]
    pub architecture: EdgeSpeechNet,
    /// Parameters common to all keyword spotting learners.
    #[param(flatten)]
    pub words: WordParams,
}

/// A loaded EdgeSpeechNet.
pub type EdgeSpeechNets = WordLearner<EdgeSpeechNetsKind>;

/// Network kind of [`EdgeSpeechNets`].
#[derive(Debug)]
pub struct EdgeSpeechNetsKind;

impl WordKind for EdgeSpeechNetsKind {
    const SPEC: Spec = Spec::new("edge_speech_nets", Task::SpeechRecognition)
        .class("EdgeSpeechNetsLearner")
        .about("EdgeSpeechNets classify spoken words; four sizes.");
    const COEFFICIENTS: usize = 24;
    type Params = EdgeSpeechNetsParams;

    fn words(params: &EdgeSpeechNetsParams) -> &WordParams {
        &params.words
    }
}
