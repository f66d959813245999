//! Heart beats of a stream as inputs of the learners.

use std::collections::VecDeque;

use opendr_engine::{Error, Pool, Result};

use crate::beats::{BeatDetector, BeatSignal};

/// State of a stream of a heart signal: its last seconds, and the incomplete beats.
///
/// Beats are detected in the first feature ([`beats`](crate::beats)). A beat is cut from a quarter of a second before it to
/// half a second after it, resampled to the length of the network's input by linear interpolation, and each feature is
/// normalised to zero mean and unit deviation, as in the UCR archive. Beats too near to the start or end of the stream are
/// skipped; a measurement that is not finite is replaced by the one before it. Time is counted in samples, so the length of the
/// pieces and their stamps do not matter.
#[derive(Debug, Default)]
pub struct BeatStream {
    signal: BeatSignal,
    /// Samples `[time, features]` from `begin` on.
    kept: VecDeque<f32>,
    begin: u64,
    /// Incomplete beats.
    found: VecDeque<u64>,
}

/// Cuts beats out of streams.
pub(super) struct Beats {
    detector: BeatDetector,
    /// Number of samples before and after a beat, and of the samples that are kept.
    before: usize,
    after: usize,
    kept: usize,
    shape: [usize; 2],
    beats: Pool<Vec<f32>>,
}

/// Seconds before and after a beat that belong to it.
const BEFORE: f64 = 0.25;
const AFTER: f64 = 0.5;
/// Seconds of a stream that are kept; beats detected later are skipped.
const KEPT: f64 = 8.0;

impl Beats {
    /// Cuts beats of `[time, features]` out of streams at `rate` Hz.
    ///
    /// # Errors
    /// As [`BeatDetector::new`]; `Format` where a size is zero.
    pub fn new(rate: f64, shape: [usize; 2]) -> Result<Self> {
        if shape.contains(&0) {
            let [time, features] = shape;
            return Err(Error::format(format!(
                "the network takes {time} time steps with {features} features; both must be at least 1"
            )));
        }
        let instants = |seconds: f64| (seconds * rate).round() as usize;
        Ok(Self {
            detector: BeatDetector::new(rate)?,
            before: instants(BEFORE),
            after: instants(AFTER),
            kept: instants(KEPT),
            shape,
            beats: Pool::default(),
        })
    }

    /// Adds samples `[time, features]` and passes each completed beat to `each`.
    ///
    /// # Errors
    /// The errors of `each`.
    pub fn push(
        &self,
        stream: &mut BeatStream,
        instants: &[f32],
        mut each: impl FnMut(&[f32]) -> Result<()>,
    ) -> Result<()> {
        let [_, features] = self.shape;
        for instant in instants.chunks_exact(features) {
            for number in instant {
                let before = stream.kept.len().checked_sub(features).and_then(|at| stream.kept.get(at));
                let number = if number.is_finite() { *number } else { before.copied().unwrap_or(0.0) };
                stream.kept.push_back(number);
            }
            let found = &mut stream.found;
            self.detector.push(&mut stream.signal, &instant[..1], |at| found.push_back(at));
            if stream.kept.len() > self.kept * features {
                stream.kept.drain(..features);
                stream.begin += 1;
            }
            self.cut(stream, &mut each)?;
        }
        Ok(())
    }

    /// Ends the stream, passes the complete beats to `each` and resets the stream.
    ///
    /// # Errors
    /// The errors of `each`.
    pub fn flush(&self, stream: &mut BeatStream, mut each: impl FnMut(&[f32]) -> Result<()>) -> Result<()> {
        let mut stream = std::mem::take(stream);
        let BeatStream { signal, found, .. } = &mut stream;
        self.detector.flush(signal, |at| found.push_back(at));
        self.cut(&mut stream, &mut each)
    }

    /// Passes the complete beats to `each`.
    fn cut(&self, stream: &mut BeatStream, each: &mut impl FnMut(&[f32]) -> Result<()>) -> Result<()> {
        let [_, features] = self.shape;
        let end = stream.begin + (stream.kept.len() / features) as u64;
        while let Some(at) = stream.found.front().copied().filter(|at| at + self.after as u64 <= end) {
            stream.found.pop_front();
            let Some(begin) = at.checked_sub(stream.begin + self.before as u64) else { continue };
            let beat = &mut *self.beats.take();
            self.resample(stream.kept.make_contiguous(), begin as usize, beat);
            each(beat)?;
        }
        Ok(())
    }

    /// Replaces `beat` by the `before + after` samples from `begin` on, resampled to the network's length.
    fn resample(&self, kept: &[f32], begin: usize, beat: &mut Vec<f32>) {
        let [time, features] = self.shape;
        let length = self.before + self.after;
        let step = (length - 1) as f64 / (time.max(2) - 1) as f64;
        beat.clear();
        for index in 0..time * features {
            let (place, feature) = ((index / features) as f64 * step, index % features);
            let (low, share) = (place as usize, place.fract() as f32);
            let number = |instant: usize| {
                kept.get((begin + instant.min(length - 1)) * features + feature).copied().unwrap_or(0.0)
            };
            beat.push(number(low) + share * (number(low + 1) - number(low)));
        }
        for feature in 0..features {
            let numbers = || beat.iter().skip(feature).step_by(features).map(|number| f64::from(*number));
            let mean = numbers().sum::<f64>() / time as f64;
            let deviation =
                (numbers().map(|number| (number - mean).powi(2)).sum::<f64>() / time as f64).sqrt();
            for number in beat.iter_mut().skip(feature).step_by(features) {
                *number = ((f64::from(*number) - mean) / deviation.max(1e-6)) as f32;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A spike every second at 100 Hz, and its double as second feature.
    fn spikes(seconds: usize) -> Vec<f32> {
        let spike =
            |at: usize| if at % 100 == 50 { 1.0 + (at / 100) as f32 * 0.01 } else { 0.01 * (at % 7) as f32 };
        (0..seconds * 100).flat_map(|at| [spike(at), 2.0 * spike(at)]).collect()
    }

    fn beats(instants: &[f32], size: usize) -> Vec<Vec<f32>> {
        let (cutter, mut stream, mut beats) =
            (Beats::new(100.0, [150, 2]).unwrap(), BeatStream::default(), Vec::new());
        let mut each = |beat: &[f32]| -> Result<()> {
            beats.push(beat.to_vec());
            Ok(())
        };
        for piece in instants.chunks(2 * size) {
            cutter.push(&mut stream, piece, &mut each).unwrap();
            assert!(stream.kept.len() <= 1600 && stream.found.len() < 20);
        }
        cutter.flush(&mut stream, &mut each).unwrap();
        beats
    }

    #[test]
    fn beats_do_not_depend_on_the_pieces() {
        let instants = spikes(30);
        let whole = beats(&instants, 3000);
        assert_eq!(whole.len(), 30);
        for size in [1, 33, 2000] {
            assert_eq!(beats(&instants, size), whole);
        }
        for beat in &whole {
            let highest = (0..150).max_by(|one, other| beat[2 * one].total_cmp(&beat[2 * other])).unwrap();
            // A quarter of a second of three quarters.
            assert!(highest.abs_diff(50) <= 2, "{highest}");
            assert!(beat.chunks(2).all(|instant| (instant[0] - instant[1]).abs() < 1e-3));
            let power: f32 = beat.iter().map(|number| number * number).sum();
            assert!((power / 300.0 - 1.0).abs() < 1e-3, "{power}");
        }
    }
}
