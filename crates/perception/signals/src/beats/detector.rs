//! Detection of beats in a signal.

use std::collections::VecDeque;

use opendr_engine::{Error, Result};

use crate::beats::filter::{Filter, FilterMemory};
use crate::beats::threshold::{Peak, Threshold};

/// Detects beats in signals of one sample rate.
#[derive(Debug, Clone)]
pub struct BeatDetector {
    rate: f64,
    high: Filter,
    low: Filter,
    /// Number of samples over which slopes are summed.
    window: usize,
    /// Minimum number of samples between two beats.
    apart: u64,
}

/// State of one signal: less than half a second of it.
#[derive(Debug, Clone, Default)]
pub struct BeatSignal {
    /// Number of samples so far.
    count: u64,
    high: FilterMemory,
    low: FilterMemory,
    /// The last five filtered samples, newest first.
    filtered: [f64; 5],
    /// The last squared slopes, and their sum.
    slopes: VecDeque<f64>,
    /// The last samples, unfiltered.
    samples: VecDeque<f32>,
    top: Peak,
    threshold: Threshold,
}

/// Pass band in Hz.
const BAND: [f64; 2] = [5.0, 15.0];
/// Seconds over which slopes are summed.
const WINDOW: f64 = 0.15;
/// Minimum seconds between two beats.
const APART: f64 = 0.2;
/// Seconds before the peak of the slopes within which the beat is.
const BEFORE_PEAK: f64 = 0.21;

impl BeatDetector {
    /// Creates a detector for signals at `rate` Hz.
    ///
    /// # Errors
    /// `InvalidParam` for a rate outside of 50 to 10000 Hz.
    pub fn new(rate: f64) -> Result<Self> {
        if !(50.0..=10_000.0).contains(&rate) {
            return Err(Error::invalid_param(format!(
                "beats cannot be detected at {rate} Hz; resample the signal to 50 to 10000 Hz"
            )));
        }
        Ok(Self {
            rate,
            high: Filter::high(BAND[0], rate),
            low: Filter::low(BAND[1], rate),
            window: (WINDOW * rate).round() as usize,
            apart: (APART * rate).round() as u64,
        })
    }

    /// Adds any number of samples in any unit and passes each beat to `each`, as its sample index from the start of the signal.
    ///
    /// A NaN or infinite sample is replaced by the one before it.
    pub fn push(&self, signal: &mut BeatSignal, samples: &[f32], mut each: impl FnMut(u64)) {
        for sample in samples {
            self.next(signal, *sample, &mut each);
        }
    }

    /// Ends the signal, passes the remaining beats to `each` and resets the signal.
    pub fn flush(&self, signal: &mut BeatSignal, mut each: impl FnMut(u64)) {
        let mut signal = std::mem::take(signal);
        if signal.top.height > 0.0 {
            self.confirm(&mut signal, &mut each);
        }
        signal.threshold.finish(self.rate, &mut each);
    }

    fn next(&self, signal: &mut BeatSignal, sample: f32, each: &mut impl FnMut(u64)) {
        let last = signal.samples.back().copied();
        let sample = if sample.is_finite() { sample } else { last.unwrap_or(0.0) };
        if last.is_none() {
            // The filters start in the steady state of the first sample.
            for _ in 0..self.rate as usize * 2 {
                self.slope(signal, sample);
            }
            signal.slopes.clear();
        }
        let slope = self.slope(signal, sample);
        let (at, kept) = (signal.count, (BEFORE_PEAK + APART) * self.rate);
        signal.count += 1;
        signal.samples.push_back(sample);
        if signal.samples.len() > kept as usize + 2 {
            signal.samples.pop_front();
        }
        signal.slopes.push_back(slope);
        if signal.slopes.len() > self.window {
            signal.slopes.pop_front();
        }
        let sum: f64 = signal.slopes.iter().sum();
        if sum > signal.top.height {
            let slope = signal.slopes.iter().copied().fold(0.0, f64::max);
            signal.top = Peak { height: sum, slope, at, beat: at };
        } else if at - signal.top.at >= self.apart && signal.top.height > 0.0 {
            self.confirm(signal, each);
            signal.top = Peak { height: 0.0, slope: 0.0, at, beat: at };
        }
    }

    /// Returns the square of the slope of the filtered signal.
    fn slope(&self, signal: &mut BeatSignal, sample: f32) -> f64 {
        let high = self.high.next(&mut signal.high, f64::from(sample));
        let filtered = self.low.next(&mut signal.low, high);
        signal.filtered.rotate_right(1);
        signal.filtered[0] = filtered;
        let [newest, new, _, old, oldest] = signal.filtered;
        ((2.0 * newest + new - old - 2.0 * oldest) / 8.0).powi(2)
    }

    /// Passes the peak on, with the sample before it that deviates most.
    fn confirm(&self, signal: &mut BeatSignal, each: &mut impl FnMut(u64)) {
        let BeatSignal { top, samples, count, threshold, .. } = signal;
        let first = *count - samples.len() as u64;
        let begin = top.at.saturating_sub((BEFORE_PEAK * self.rate) as u64).max(first);
        let part = || samples.iter().skip((begin - first) as usize).take((top.at - begin + 1) as usize);
        let mean = part().map(|sample| f64::from(*sample)).sum::<f64>() / (top.at - begin + 1) as f64;
        let mut most = 0.0;
        for (at, sample) in (begin..).zip(part()) {
            let height = (f64::from(*sample) - mean).abs();
            if height > most {
                (most, top.beat) = (height, at);
            }
        }
        threshold.next(*top, self.rate, each);
    }
}

#[cfg(test)]
mod tests;
