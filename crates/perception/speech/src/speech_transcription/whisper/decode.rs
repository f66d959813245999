//! Decoding of a window to tokens: openai/whisper's `DecodingTask` and its temperature fallback.

use std::io::Write;

use flate2::Compression;
use flate2::write::ZlibEncoder;
use opendr_engine::{Random, Result};

use super::beam::Beams;
use super::decoding::{Candidate, Decoded, Decoding, Prefilled};
use super::network::KeyValueCache;
use super::rules::log_sum_exp;

impl Decoding<'_> {
    /// Decodes at one temperature after the other until the result is neither repetitive nor unlikely.
    ///
    /// # Errors
    /// The errors of the runtime.
    pub fn run(&self, temperatures: &[f32], seed: u64) -> Result<Decoded> {
        let prefilled = self.begin()?;
        let mut decoded = Decoded::default();
        let temperatures = if temperatures.is_empty() { &[0.0] } else { temperatures };
        for temperature in temperatures {
            decoded = self.at(&prefilled, *temperature, seed)?;
            if !self.is_rejected(&decoded) {
                break;
            }
        }
        Ok(decoded)
    }

    fn is_rejected(&self, decoded: &Decoded) -> bool {
        let options = self.options;
        let unlikely = options.logprob_threshold.is_some_and(|least| decoded.avg_logprob < least);
        let repeats =
            options.compression_ratio_threshold.is_some_and(|most| decoded.compression_ratio > most);
        let silent = options.no_speech_threshold.is_some_and(|most| decoded.no_speech_prob > most);
        (unlikely || repeats) && !(silent && unlikely)
    }

    /// Decodes the initial tokens and computes the probability of no speech.
    fn begin(&self) -> Result<Prefilled> {
        let beginning = &self.options.beginning;
        let start = beginning.iter().position(|token| *token == self.vocabulary.start).unwrap_or_default();
        let (to_start, rest) = beginning.split_at((start + 1).min(beginning.len()));
        let mut prefilled =
            Prefilled { cache: KeyValueCache::default(), logits: Vec::new(), no_speech_prob: 0.0 };
        self.network.clear_cache(&mut prefilled.cache);
        self.network.decode(self.encoded, &mut prefilled.cache, to_start, &mut prefilled.logits)?;
        let no_speech = prefilled.logits.get(self.vocabulary.no_speech as usize).copied().unwrap_or_default();
        prefilled.no_speech_prob = (no_speech - log_sum_exp(&prefilled.logits)).exp();
        if !rest.is_empty() {
            self.network.decode(self.encoded, &mut prefilled.cache, rest, &mut prefilled.logits)?;
        }
        Ok(prefilled)
    }

    fn at(&self, prefilled: &Prefilled, temperature: f32, seed: u64) -> Result<Decoded> {
        let candidates = match (temperature > 0.0, self.options.beam_size) {
            (false, Some(size)) => Beams::new(self, size, self.options.patience).run(prefilled)?,
            (false, None) => vec![self.sample(prefilled, 0.0, seed)?],
            (true, _) => {
                let seeds = (0..self.options.best_of.max(1)).map(|number| {
                    Random::from_key([seed, u64::from(temperature.to_bits()), number as u64]).bits()
                });
                seeds.map(|seed| self.sample(prefilled, temperature, seed)).collect::<Result<_>>()?
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
            no_speech_prob: prefilled.no_speech_prob,
            tokens,
        })
    }

    fn sample(&self, prefilled: &Prefilled, temperature: f32, seed: u64) -> Result<Candidate> {
        let (mut cache, mut logits) = (prefilled.cache.clone(), prefilled.logits.clone());
        let mut random = Random::new(seed);
        let (mut candidate, max_tokens) = (Candidate::default(), self.max_tokens());
        while candidate.tokens.len() < max_tokens {
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
            if candidate.tokens.len() < max_tokens {
                self.network.decode(self.encoded, &mut cache, &[next], &mut logits)?;
            }
        }
        Ok(candidate)
    }
}

fn likeliest(logits: &[f32]) -> usize {
    let best = logits.iter().enumerate().reduce(|best, other| if other.1 > best.1 { other } else { best });
    best.map_or(0, |(token, _)| token)
}

/// Returns the token whose interval of the cumulative distribution at `temperature` contains `unit`, which is in [0, 1).
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

/// Returns the length of a text divided by its length compressed by zlib: high for repetitions.
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
    fn draws_follow_the_probabilities() {
        let logits = [f32::NEG_INFINITY, 1f32.ln(), 3f32.ln(), f32::NEG_INFINITY];
        let token = |unit| drawn(&logits, 1.0, unit);
        assert_eq!([token(0.0), token(0.24), token(0.26), token(0.999_999)], [1, 1, 2, 2]);
        // A lower temperature favours the likeliest token: 1 to 9.
        assert_eq!([0.09, 0.11].map(|unit| drawn(&logits, 0.5, unit)), [1, 2]);
        assert_eq!(likeliest(&logits), 2);
    }

    #[test]
    fn repetitions_compress_well() {
        assert!(compression_ratio(&"try again. ".repeat(30)) > 10.0);
        assert!(compression_ratio("Ever tried, ever failed.") < 1.0);
        assert_eq!(compression_ratio(""), 0.0);
    }
}
