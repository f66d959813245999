//! Beam search (openai/whisper's `BeamSearchDecoder`).

use opendr_engine::Result;

use super::decoding::{Candidate, Decoding, Prefilled};
use super::network::KeyValueCache;
use super::rules::log_sum_exp;

/// A beam search with a fixed number of unfinished texts.
pub struct Beams<'a, 'b> {
    decoding: &'a Decoding<'b>,
    size: usize,
    /// Number of finished texts that ends the search.
    enough: usize,
}

struct Beam {
    candidate: Candidate,
    cache: KeyValueCache,
    logits: Vec<f32>,
}

impl<'a, 'b> Beams<'a, 'b> {
    pub fn new(decoding: &'a Decoding<'b>, size: usize, patience: f32) -> Self {
        let enough = (size as f32 * patience).round().max(1.0) as usize;
        Self { decoding, size: size.max(1), enough }
    }

    /// Returns the finished texts, completed by the likeliest unfinished ones where there are too few.
    pub fn run(&self, prefilled: &Prefilled) -> Result<Vec<Candidate>> {
        let (cache, logits) = (prefilled.cache.clone(), prefilled.logits.clone());
        let mut beams = vec![Beam { candidate: Candidate::default(), cache, logits }];
        let mut finished = Vec::new();
        for step in 0..self.decoding.max_tokens() {
            let last = step + 1 == self.decoding.max_tokens();
            beams = self.step(beams, &mut finished, last)?;
            if finished.len() >= self.enough || beams.is_empty() {
                break;
            }
        }
        let missing = self.size.saturating_sub(finished.len());
        finished.extend(beams.into_iter().map(|beam| beam.candidate).take(missing));
        Ok(finished)
    }

    fn step(&self, mut beams: Vec<Beam>, finished: &mut Vec<Candidate>, last: bool) -> Result<Vec<Beam>> {
        let Decoding { network, vocabulary, encoded, options } = *self.decoding;
        let mut next: Vec<(f32, usize, u32)> = Vec::new();
        for (source, beam) in beams.iter_mut().enumerate() {
            options.rules.apply(&mut beam.logits, &beam.candidate.tokens);
            let all = log_sum_exp(&beam.logits);
            let likeliest = largest(&beam.logits, self.size + 1);
            next.extend(
                likeliest.into_iter().map(|(token, logit)| (beam.candidate.sum + logit - all, source, token)),
            );
        }
        next.sort_by(|a, b| b.0.total_cmp(&a.0));
        let mut kept = Vec::with_capacity(self.size);
        for (sum, source, token) in next {
            let Some(beam) = beams.get(source) else { continue };
            let mut tokens = beam.candidate.tokens.clone();
            if token == vocabulary.end {
                if finished.len() < self.enough {
                    finished.push(Candidate { tokens, sum });
                }
                continue;
            }
            tokens.push(token);
            let (mut cache, mut logits) = (beam.cache.clone(), Vec::new());
            if !last {
                network.decode(encoded, &mut cache, &[token], &mut logits)?;
            }
            kept.push(Beam { candidate: Candidate { tokens, sum }, cache, logits });
            if kept.len() == self.size {
                break;
            }
        }
        Ok(kept)
    }
}

/// Returns the `count` largest finite logits with their tokens, largest first.
fn largest(logits: &[f32], count: usize) -> Vec<(u32, f32)> {
    let mut found: Vec<(u32, f32)> = Vec::with_capacity(count + 1);
    for (token, logit) in logits.iter().enumerate() {
        let worse = found.len() == count && found.last().is_some_and(|(_, least)| logit <= least);
        if worse || *logit == f32::NEG_INFINITY {
            continue;
        }
        let place = found.partition_point(|(_, other)| other >= logit);
        found.insert(place, (token as u32, *logit));
        found.truncate(count);
    }
    found
}

#[cfg(test)]
mod tests {
    #[test]
    fn the_largest_in_order() {
        let logits = [0.5, f32::NEG_INFINITY, 2.0, 1.0, 2.0];
        assert_eq!(super::largest(&logits, 3), [(2, 2.0), (4, 2.0), (3, 1.0)]);
        assert_eq!(super::largest(&logits[..2], 3), [(0, 0.5)]);
    }
}
