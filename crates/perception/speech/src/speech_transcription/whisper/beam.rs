//! The likeliest texts, side by side (openai/whisper's `BeamSearchDecoder`).

use opendr_engine::Result;

use super::decode::{Begun, Candidate, Decoding};
use super::network::Memory;
use super::rules::log_sum_exp;

/// A search with a fixed number of texts that go on.
pub struct Beams<'a, 'b> {
    decoding: &'a Decoding<'b>,
    size: usize,
    /// The search ends with so many texts that are finished.
    enough: usize,
}

struct Beam {
    candidate: Candidate,
    memory: Memory,
    logits: Vec<f32>,
}

impl<'a, 'b> Beams<'a, 'b> {
    pub fn new(decoding: &'a Decoding<'b>, size: usize, patience: f32) -> Self {
        let enough = (size as f32 * patience).round().max(1.0) as usize;
        Self { decoding, size: size.max(1), enough }
    }

    /// The texts that were finished, and where they are too few the likeliest of the others.
    pub fn run(&self, begun: &Begun) -> Result<Vec<Candidate>> {
        let (memory, logits) = (begun.memory.clone(), begun.logits.clone());
        let mut beams = vec![Beam { candidate: Candidate::default(), memory, logits }];
        let mut finished = Vec::new();
        for step in 0..self.decoding.room() {
            let last = step + 1 == self.decoding.room();
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
        let Decoding { network, vocabulary, heard, options } = *self.decoding;
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
            let (mut memory, mut logits) = (beam.memory.clone(), Vec::new());
            if !last {
                network.read(heard, &mut memory, &[token], &mut logits)?;
            }
            kept.push(Beam { candidate: Candidate { tokens, sum }, memory, logits });
            if kept.len() == self.size {
                break;
            }
        }
        Ok(kept)
    }
}

/// The `count` largest that are possible, largest first.
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
