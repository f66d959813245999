//! From the tokens of a window to its segments, and to where the next window begins.

use super::decode::Decoded;
use super::vocabulary::Vocabulary;

/// Frames of the spectrogram that a step of the times spans.
const FRAMES: usize = 2;
/// Seconds of it.
const STEP_S: f32 = 0.02;

/// A part of a window.
#[derive(Debug, Clone, PartialEq)]
pub struct Part {
    /// Begin and end within the window, seconds.
    pub start: f32,
    pub end: f32,
    pub tokens: Vec<u32>,
}

/// Cuts a window of `frames` frames where its times say, and tells how many of the frames were understood: the next
/// window begins behind them.
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
