//! A self-organised operational network of quadratic neurons over cepstra.
//!
//! Kiranyaz et al., Self-Organized Operational Neural Networks with Generative Neurons, Neural Networks 2021, for the powers
//! that a neuron takes of its input; Zoumpourlis et al., Non-linear Convolution Filters for CNN-based Learning, ICCV
//! 2017, for the products of neighbours. Two layers only: small, and slower for each number that it has than a
//! convolution. A stream of sound is answered twice a second, each time for the second before.

#[cfg(feature = "training")]
mod network;
#[cfg(feature = "training")]
mod quadratic_convolution;
#[cfg(feature = "training")]
mod training;

use opendr_engine::Task;
use opendr_engine::learner::Spec;
use opendr_engine::params::Params;

use crate::speech_recognition::word_learner::{WordKind, WordLearner, WordParams};
#[cfg(feature = "training")]
pub use training::QuadraticSelfOnnFitParams;

/// What a user may set.
#[derive(Debug, Clone, Params)]
pub struct QuadraticSelfOnnParams {
    /// Up to which power neurons take their input, in the network that is trained; a loaded model has its own.
    #[param(default = 3, range = 1..=9)]
    pub expansion_order: usize,
    /// What all learners of words have.
    #[param(flatten)]
    pub words: WordParams,
}

/// A loaded network of quadratic neurons.
pub type QuadraticSelfOnn = WordLearner<QuadraticSelfOnnKind>;

/// Which network it is.
#[derive(Debug)]
pub struct QuadraticSelfOnnKind;

impl WordKind for QuadraticSelfOnnKind {
    const SPEC: Spec = Spec::new("quadratic_self_onn", Task::SpeechRecognition)
        .class("QuadraticSelfOnnLearner")
        .about("Two layers of quadratic neurons tell which of a few words was spoken.");
    const COEFFICIENTS: usize = 16;
    type Params = QuadraticSelfOnnParams;

    fn words(params: &QuadraticSelfOnnParams) -> &WordParams {
        &params.words
    }
}
