//! A self-organised operational neural network (Self-ONN) of quadratic neurons on cepstra.
//!
//! Kiranyaz et al., Self-Organized Operational Neural Networks with Generative Neurons, Neural Networks 2021, for the powers of
//! a neuron's input; Zoumpourlis et al., Non-linear Convolution Filters for CNN-based Learning, ICCV 2017, for the products of
//! neighbours. Two layers only: few parameters, but more arithmetic per parameter than a convolution. A stream of audio yields
//! a prediction twice per second, each for the last second.

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

/// Parameters of [`QuadraticSelfOnn`].
#[derive(Debug, Clone, Params)]
pub struct QuadraticSelfOnnParams {
    /// Highest power of the input in a neuron of the network that is trained; a loaded model has its own.
    #[param(default = 3, range = 1..=9)]
    pub expansion_order: usize,
    /// Parameters common to all keyword spotting learners.
    #[param(flatten)]
    pub words: WordParams,
}

/// A loaded network of quadratic neurons.
pub type QuadraticSelfOnn = WordLearner<QuadraticSelfOnnKind>;

/// Network kind of [`QuadraticSelfOnn`].
#[derive(Debug)]
pub struct QuadraticSelfOnnKind;

impl WordKind for QuadraticSelfOnnKind {
    const SPEC: Spec = Spec::new("quadratic_self_onn", Task::SpeechRecognition)
        .class("QuadraticSelfOnnLearner")
        .about("A Self-ONN of two layers of quadratic neurons classifies spoken words.");
    const COEFFICIENTS: usize = 16;
    type Params = QuadraticSelfOnnParams;

    fn words(params: &QuadraticSelfOnnParams) -> &WordParams {
        &params.words
    }
}
