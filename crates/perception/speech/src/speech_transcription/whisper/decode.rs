//! From a window of sound to tokens: openai/whisper's `DecodingTask` and its fallback.

use std::io::Write;

use flate2::Compression;
use flate2::write::ZlibEncoder;
use opendr_engine::{Random, Result};

use super::beam::Beams;
use super::network::{CONTEXT, Heard, Memory, Network};
use super::rules::{Rules, log_sum_exp};
use super::vocabulary::Vocabulary;

/// How a window is decoded.
pub struct DecodeOptions<'a> {
    pub rules: Rules<'a>,
    /// What the decoder begins with, the token [`Vocabulary::start`] among it.
    pub beginning: Vec<u32>,
    /// The most tokens of a window.
    pub sample_len: usize,
    pub best_of: usize,
    pub beam_size: Option<usize>,
    pub patience: f32,
    pub length_penalty: Option<f32>,
    pub compression_ratio_threshold: Option<f32>,
    pub logprob_threshold: Option<f32>,
    pub no_speech_threshold: Option<f32>,
}

/// What was said in a window.
#[derive(Debug, Clone, Default)]
pub struct Decoded {
    pub tokens: Vec<u32>,
    pub temperature: f32,
    /// Mean of the logarithms of the tokens' probabilities, the end's among them.
    pub avg_logprob: f32,
    pub compression_ratio: f32,
    pub no_speech_prob: f32,
}

/// Where the decoder stands before the first token of a text.
pub struct Begun {
    pub memory: Memory,
    pub logits: Vec<f32>,
    no_speech_prob: f32,
}

/// Tokens with the sum of the logarithms of their probabilities.
#[derive(Debug, Clone, Default)]
pub struct Candidate {
    pub tokens: Vec<u32>,
    pub sum: f32,
}

/// A network that heard a window.
pub struct Decoding<'a> {
    pub network: &'a Network,
    pub vocabulary: &'a Vocabulary,
    pub heard: &'a Heard,
    pub options: &'a DecodeOptions<'a>,
}

impl Decoding<'_> {
    /// Decodes at one temperature after the other until what comes is no stammering and likely enough.
    ///
    /// # Errors
    /// What the runtime meets.
    pub fn run(&self, temperatures: &[f32], seed: u64) -> Result<Decoded> {
        let begun = self.begin()?;
        let mut decoded = Decoded::default();
        let temperatures = if temperatures.is_empty() { &[0.0] } else { temperatures };
        for temperature in temperatures {
            decoded = self.at(&begun, *temperature, seed)?;
            if !self.fails(&decoded) {
                break;
            }
        }
        Ok(decoded)
    }

    fn fails(&self, decoded: &Decoded) -> bool {
        let options = self.options;
        let unlikely = options.logprob_threshold.is_some_and(|least| decoded.avg_logprob < least);
        let stammers =
            options.compression_ratio_threshold.is_some_and(|most| decoded.compression_ratio > most);
        let silent = options.no_speech_threshold.is_some_and(|most| decoded.no_speech_prob > most);
        (unlikely || stammers) && !(silent && unlikely)
    }

    /// Reads what the text begins with, and learns on the way whether anybody speaks.
    fn begin(&self) -> Result<Begun> {
        let beginning = &self.options.beginning;
        let start = beginning.iter().position(|token| *token == self.vocabulary.start).unwrap_or_default();
        let (to_start, rest) = beginning.split_at((start + 1).min(beginning.len()));
        let mut begun = Begun { memory: Memory::default(), logits: Vec::new(), no_speech_prob: 0.0 };
        self.network.forget(&mut begun.memory);
        self.network.read(self.heard, &mut begun.memory, to_start, &mut begun.logits)?;
        let no_speech = begun.logits.get(self.vocabulary.no_speech as usize).copied().unwrap_or_default();
        begun.no_speech_prob = (no_speech - log_sum_exp(&begun.logits)).exp();
        if !rest.is_empty() {
            self.network.read(self.heard, &mut begun.memory, rest, &mut begun.logits)?;
        }
        Ok(begun)
    }

    fn at(&self, begun: &Begun, temperature: f32, seed: u64) -> Result<Decoded> {
        let candidates = match (temperature > 0.0, self.options.beam_size) {
            (false, Some(size)) => Beams::new(self, size, self.options.patience).run(begun)?,
            (false, None) => vec![self.sample(begun, 0.0, seed)?],
            (true, _) => {
                let seeds = (0..self.options.best_of.max(1))
                    .map(|number| Random::at([seed, u64::from(temperature.to_bits()), number as u64]).bits());
                seeds.map(|seed| self.sample(begun, temperature, seed)).collect::<Result<_>>()?
            }
        };
        let rank = |candidate: &Candidate| {
            let length = candidate.tokens.len() as f32;
            let penalty =
                self.options.length_penalty.map_or(length, |power| ((5.0 + length) / 6.0).powf(power));
            if penalty > 0.0 { candidate.sum / penalty } else { candidate.sum }
        };
        let best = candidates.into_iter().reduce(
            |best, other| {
                if rank(&other) > rank(&best) { other } else { best }
            },
        );
        let Candidate { tokens, sum } = best.unwrap_or_default();
        Ok(Decoded {
            temperature,
            avg_logprob: sum / (tokens.len() + 1) as f32,
            compression_ratio: compression_ratio(self.vocabulary.text(&tokens).trim()),
            no_speech_prob: begun.no_speech_prob,
            tokens,
        })
    }

    /// How many tokens a text may have at most.
    pub fn room(&self) -> usize {
        self.options.sample_len.min(CONTEXT.saturating_sub(self.options.beginning.len()))
    }

    fn sample(&self, begun: &Begun, temperature: f32, seed: u64) -> Result<Candidate> {
        let (mut memory, mut logits) = (begun.memory.clone(), begun.logits.clone());
        let mut random = Random::new(seed);
        let (mut candidate, room) = (Candidate::default(), self.room());
        while candidate.tokens.len() < room {
            self.options.rules.apply(&mut logits, &candidate.tokens);
            let next = match temperature > 0.0 {
                true => drawn(&logits, temperature, random.unit()),
                false => likeliest(&logits),
            };
            candidate.sum += logits.get(next).copied().unwrap_or_default() - log_sum_exp(&logits);
            let next = next as u32;
            if next == self.vocabulary.end {
                break;
            }
            candidate.tokens.push(next);
            if candidate.tokens.len() < room {
                self.network.read(self.heard, &mut memory, &[next], &mut logits)?;
            }
        }
        Ok(candidate)
    }
}

fn likeliest(logits: &[f32]) -> usize {
    let best = logits.iter().enumerate().reduce(|best, other| if other.1 > best.1 { other } else { best });
    best.map_or(0, |(token, _)| token)
}

/// The token in whose share of the probabilities at `temperature` the place `unit` in [0, 1) lies.
fn drawn(logits: &[f32], temperature: f32, unit: f64) -> usize {
    let most = logits.iter().copied().fold(f32::NEG_INFINITY, f32::max);
    let weight = |logit: &f32| f64::from((logit - most) / temperature).exp();
    let mut rest = unit * logits.iter().map(weight).sum::<f64>();
    let place = logits.iter().position(|logit| {
        rest -= weight(logit);
        rest < 0.0
    });
    place.unwrap_or_else(|| likeliest(logits))
}

/// Length of a text over its length when packed by zlib: high for repetitions.
fn compression_ratio(text: &str) -> f32 {
    let mut packed = ZlibEncoder::new(Vec::new(), Compression::default());
    // Writing to memory does not fail.
    let packed = packed.write_all(text.as_bytes()).and_then(|()| packed.finish()).unwrap_or_default();
    text.len() as f32 / packed.len().max(1) as f32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn draws_follow_the_weights() {
        let logits = [f32::NEG_INFINITY, 1f32.ln(), 3f32.ln(), f32::NEG_INFINITY];
        let token = |unit| drawn(&logits, 1.0, unit);
        assert_eq!([token(0.0), token(0.24), token(0.26), token(0.999_999)], [1, 1, 2, 2]);
        // The colder, the likelier the likeliest: 1 to 9.
        assert_eq!([0.09, 0.11].map(|unit| drawn(&logits, 0.5, unit)), [1, 2]);
        assert_eq!(likeliest(&logits), 2);
    }

    #[test]
    fn repetitions_pack_well() {
        assert!(compression_ratio(&"try again. ".repeat(30)) > 10.0);
        assert!(compression_ratio("Ever tried, ever failed.") < 1.0);
        assert_eq!(compression_ratio(""), 0.0);
    }
}
