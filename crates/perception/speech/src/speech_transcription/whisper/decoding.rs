//! Options, state and results of decoding a window.

use super::network::{CONTEXT, EncoderOutput, KeyValueCache, Network};
use super::rules::Rules;
use super::vocabulary::Vocabulary;

/// Options of decoding a window.
pub struct DecodeOptions<'a> {
    pub rules: Rules<'a>,
    /// Initial tokens of the decoder, among them [`Vocabulary::start`].
    pub beginning: Vec<u32>,
    /// Maximum number of tokens of a window.
    pub sample_len: usize,
    pub best_of: usize,
    pub beam_size: Option<usize>,
    pub patience: f32,
    pub length_penalty: Option<f32>,
    pub compression_ratio_threshold: Option<f32>,
    pub logprob_threshold: Option<f32>,
    pub no_speech_threshold: Option<f32>,
}

/// Decoded tokens of a window.
#[derive(Debug, Clone, Default)]
pub struct Decoded {
    pub tokens: Vec<u32>,
    pub temperature: f32,
    /// Mean log-probability of the tokens, including that of the end.
    pub avg_logprob: f32,
    pub compression_ratio: f32,
    pub no_speech_prob: f32,
}

/// State of the decoder before the first token of the text.
pub struct Prefilled {
    pub cache: KeyValueCache,
    pub logits: Vec<f32>,
    pub(super) no_speech_prob: f32,
}

/// Tokens with the sum of their log-probabilities.
#[derive(Debug, Clone, Default)]
pub struct Candidate {
    pub tokens: Vec<u32>,
    pub sum: f32,
}

/// Decoder of an encoded window.
pub struct Decoding<'a> {
    pub network: &'a Network,
    pub vocabulary: &'a Vocabulary,
    pub encoded: &'a EncoderOutput,
    pub options: &'a DecodeOptions<'a>,
}

impl Decoding<'_> {
    /// Returns the maximum number of tokens of a text.
    pub fn max_tokens(&self) -> usize {
        self.options.sample_len.min(CONTEXT.saturating_sub(self.options.beginning.len()))
    }
}
