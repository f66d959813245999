//! Logit filters (openai/whisper's `SuppressBlank`, `SuppressTokens` and `ApplyTimestampRules`).

use super::vocabulary::Vocabulary;

/// Logit filters of one window.
pub struct Rules<'a> {
    pub vocabulary: &'a Vocabulary,
    /// Whether a text must not begin with a space or with its end.
    pub suppress_blank: bool,
    /// Tokens that are never decoded.
    pub suppressed: &'a [u32],
    /// Whether timestamps are decoded.
    pub times: bool,
    /// Latest first timestamp, in steps of 20 ms.
    pub latest_begin: Option<u32>,
}

const NEVER: f32 = f32::NEG_INFINITY;

impl Rules<'_> {
    /// Sets the logit of every token that must not follow `sampled`, the tokens of this window so far, to minus infinity.
    pub fn apply(&self, logits: &mut [f32], sampled: &[u32]) {
        if self.suppress_blank && sampled.is_empty() {
            forbid(logits, &self.vocabulary.blank);
        }
        forbid(logits, self.suppressed);
        if self.times {
            self.apply_times(logits, sampled);
        }
    }

    /// Timestamps come in pairs, the end of a segment and the start of the next, and never decrease.
    fn apply_times(&self, logits: &mut [f32], sampled: &[u32]) {
        let Vocabulary { first_time, end, no_times, .. } = *self.vocabulary;
        let is_time = |token: &u32| *token >= first_time;
        forbid(logits, &[no_times]);
        let mut newest = sampled.iter().rev();
        let last_is_time = newest.next().is_some_and(is_time);
        let one_before_is_time = newest.next().is_none_or(is_time);
        match (last_is_time, one_before_is_time) {
            (true, true) => forbid_range(logits, first_time, u32::MAX),
            (true, false) => forbid_range(logits, 0, end),
            _ => {}
        }
        if let Some(time) = sampled.iter().rev().copied().find(is_time) {
            // A segment is never empty.
            let earliest = if last_is_time && !one_before_is_time { time } else { time + 1 };
            forbid_range(logits, first_time, earliest);
        }
        if sampled.is_empty() {
            forbid_range(logits, 0, first_time);
            if let Some(latest) = self.latest_begin {
                forbid_range(logits, first_time.saturating_add(latest).saturating_add(1), u32::MAX);
            }
        }
        let (words, times) = logits.split_at(logits.len().min(first_time as usize));
        let likeliest = words.iter().copied().fold(NEVER, f32::max);
        if log_sum_exp(times) > likeliest {
            forbid_range(logits, 0, first_time);
        }
    }
}

fn forbid(logits: &mut [f32], tokens: &[u32]) {
    for token in tokens {
        if let Some(logit) = logits.get_mut(*token as usize) {
            *logit = NEVER;
        }
    }
}

fn forbid_range(logits: &mut [f32], begin: u32, end: u32) {
    let end = logits.len().min(end as usize);
    if let Some(range) = logits.get_mut(begin as usize..end) {
        range.fill(NEVER);
    }
}

/// Returns the logarithm of the sum of exponentials; minus infinity for no logits.
pub fn log_sum_exp(logits: &[f32]) -> f32 {
    let most = logits.iter().copied().fold(NEVER, f32::max);
    if most == NEVER {
        return NEVER;
    }
    let sum: f64 = logits.iter().map(|logit| f64::from(logit - most).exp()).sum();
    most + sum.ln() as f32
}
