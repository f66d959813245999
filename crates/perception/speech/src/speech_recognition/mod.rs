//! Keyword spotting: classification of spoken words.

mod cepstra;
mod ds_cnn;
mod edge_speech_nets;
mod matchboxnet;
mod quadratic_self_onn;
mod word_learner;
mod word_stream;

pub use ds_cnn::{DsCnn, DsCnnParams};
pub use edge_speech_nets::{EdgeSpeechNet, EdgeSpeechNets, EdgeSpeechNetsKind, EdgeSpeechNetsParams};
pub use matchboxnet::{MatchboxNet, MatchboxNetKind, MatchboxNetParams};
pub use opendr_audio::AudioInput;
pub use quadratic_self_onn::{QuadraticSelfOnn, QuadraticSelfOnnKind, QuadraticSelfOnnParams};
pub use word_learner::{WordKind, WordLearner, WordParams};
pub use word_stream::{WordStream, WordStreamParams};
#[cfg(feature = "training")]
pub use {
    edge_speech_nets::EdgeSpeechNetsFitParams,
    matchboxnet::MatchboxNetFitParams,
    quadratic_self_onn::QuadraticSelfOnnFitParams,
    word_learner::{TrainableWords, WordFitParams},
};
