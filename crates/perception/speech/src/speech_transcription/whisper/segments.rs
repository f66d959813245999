//! Segments of a window, and the start of the next window.

use super::decoding::Decoded;
use super::vocabulary::Vocabulary;

/// Spectrogram frames per timestamp step.
const FRAMES: usize = 2;
/// Seconds per timestamp step.
const STEP_S: f32 = 0.02;

/// A segment of a window.
#[derive(Debug, Clone, PartialEq)]
pub struct Part {
    /// Start and end within the window in seconds.
    pub start: f32,
    pub end: f32,
    pub tokens: Vec<u32>,
}

/// Splits a window of `frames` frames at its timestamps. Returns the segments and the number of frames they cover; the next
/// window begins there.
pub fn cut(decoded: &Decoded, vocabulary: &Vocabulary, frames: usize) -> (Vec<Part>, usize) {
    let tokens = &decoded.tokens;
    let step = |token: &u32| token.checked_sub(vocabulary.first_time);
    let seconds = |token: &u32| step(token).unwrap_or_default() as f32 * STEP_S;
    let is_time = |token: &u32| step(token).is_some();
    let ends_in_one_time = match tokens.as_slice() {
        [.., before, last] => !is_time(before) && is_time(last),
        _ => false,
    };
    let pairs = tokens.windows(2).enumerate().filter(|(_, pair)| pair.iter().all(is_time));
    let mut cuts: Vec<usize> = pairs.map(|(at, _)| at + 1).collect();
    if cuts.is_empty() {
        let last = tokens.iter().rfind(|token| step(token).is_some_and(|step| step > 0));
        let end = last.map_or(frames as f32 / 100.0, seconds);
        return (vec![Part { start: 0.0, end, tokens: tokens.clone() }], frames);
    }
    if ends_in_one_time {
        cuts.push(tokens.len());
    }
    let (mut parts, mut begin) = (Vec::new(), 0);
    for end in cuts {
        let part = tokens.get(begin..end).unwrap_or_default();
        let bounds = [part.first(), part.last()].map(|token| token.map_or(0.0, seconds));
        parts.push(Part { start: bounds[0], end: bounds[1], tokens: part.to_vec() });
        begin = end;
    }
    if ends_in_one_time {
        return (parts, frames);
    }
    let last = begin.checked_sub(1).and_then(|at| tokens.get(at)).and_then(step).unwrap_or_default();
    (parts, last as usize * FRAMES)
}
