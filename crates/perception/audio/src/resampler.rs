//! Resampling of audio.
//!
//! Windowed sinc interpolation (Smith, Digital Audio Resampling, 1984) with a Kaiser window of 32 zero crossings on each side:
//! frequencies above 0.93 of half the lower rate are attenuated, aliases by about 80 dB. The result of a stream does not depend
//! on its pieces.

use std::f64::consts::PI;

use opendr_engine::{Error, Result};

/// Zero crossings on each side.
const ZEROS: usize = 32;
/// Table entries per zero crossing.
const STEPS: usize = 512;
/// Pass band as a share of half the lower rate.
const ROLL_OFF: f64 = 0.93;
/// Beta of the Kaiser window.
const BETA: f64 = 9.0;

/// Maximum number of precomputed weights; beyond, weights are computed for each output.
const MOST_WEIGHTS: usize = 1 << 17;

/// Supported sample rates in Hz.
const RATES: std::ops::RangeInclusive<u32> = 1000..=768_000;

/// Resampler of one stream of audio.
#[derive(Debug)]
pub struct Resampler {
    from: u32,
    to: u32,
    kernel: Kernel,
    /// Precomputed weights of the samples around an output, for each position of an output between two samples; empty where
    /// there are too many.
    weights: Vec<f32>,
    /// Distance between such positions, in units of `1 / to` sample.
    stride: u64,
    /// Number of samples on each side that an output depends on.
    reach: usize,
    pending: Vec<f32>,
    /// Position of the next output relative to the first of `pending`, in units of `1 / to` sample.
    next: u64,
    taken: u64,
    given: u64,
}

/// Half of the scaled windowed sinc, `STEPS` entries per zero crossing.
#[derive(Debug)]
struct Kernel {
    table: Vec<f32>,
    /// Table entries per sample.
    stretch: f64,
}

impl Kernel {
    fn new(cutoff: f64) -> Self {
        let entry = |at: usize| {
            let time = at as f64 / STEPS as f64;
            let edge = 1.0 - (time / ZEROS as f64).powi(2);
            let sinc = if at == 0 { 1.0 } else { (PI * time).sin() / (PI * time) };
            (cutoff * sinc * bessel(BETA * edge.max(0.0).sqrt()) / bessel(BETA)) as f32
        };
        Self { table: (0..=ZEROS * STEPS).map(entry).collect(), stretch: cutoff * STEPS as f64 }
    }

    /// Returns the weight of a sample at a distance in samples.
    fn weight(&self, distance: f64) -> f32 {
        let entry = distance.abs() * self.stretch;
        let index = entry as usize;
        match (self.table.get(index), self.table.get(index + 1)) {
            (Some(low), Some(high)) => low + (high - low) * (entry - index as f64) as f32,
            _ => 0.0,
        }
    }
}

impl Resampler {
    /// Creates a resampler from `from` to `to` Hz.
    ///
    /// # Errors
    /// `InvalidInput` for a rate outside of 1,000 to 768,000 Hz.
    pub fn new(from: u32, to: u32) -> Result<Self> {
        if let Some(rate) = [from, to].iter().find(|rate| !RATES.contains(rate)) {
            return Err(Error::invalid_input(format!(
                "audio at {rate} Hz cannot be resampled; the rate must be {} to {} Hz",
                RATES.start(),
                RATES.end()
            )));
        }
        let cutoff = ROLL_OFF * (f64::from(to) / f64::from(from)).min(1.0);
        let reach = if from == to { 0 } else { (ZEROS as f64 / cutoff).ceil() as usize };
        let kernel = Kernel::new(cutoff);
        let stride = u64::from(divisor(from, to));
        let (places, taps) = ((u64::from(to) / stride) as usize, 2 * reach + 1);
        let mut weights = Vec::new();
        if places * taps <= MOST_WEIGHTS && reach > 0 {
            for place in 0..places {
                let place = place as f64 / places as f64 + reach as f64;
                weights.extend((0..taps).map(|at| kernel.weight(at as f64 - place)));
            }
        }
        Ok(Self {
            from,
            to,
            kernel,
            weights,
            stride,
            reach,
            pending: vec![0.0; reach],
            next: reach as u64 * u64::from(to),
            taken: 0,
            given: 0,
        })
    }

    /// Returns the sample rate of the input in Hz.
    pub fn from_rate(&self) -> u32 {
        self.from
    }

    /// Adds a piece and appends the completed samples to `resampled`.
    pub fn push(&mut self, piece: &[f32], resampled: &mut Vec<f32>) {
        self.taken += piece.len() as u64;
        if self.from == self.to {
            resampled.extend_from_slice(piece);
            return;
        }
        self.pending.extend_from_slice(piece);
        self.run(u64::MAX, resampled);
    }

    /// Ends the stream and appends the rest; the total number of samples is the duration times the new rate, rounded up.
    pub fn finish(&mut self, resampled: &mut Vec<f32>) {
        if self.from != self.to {
            let all = (self.taken * u64::from(self.to)).div_ceil(u64::from(self.from));
            self.pending.resize(self.pending.len() + 2 * self.reach + 1, 0.0);
            self.run(all, resampled);
        }
        self.pending.clear();
        self.pending.resize(self.reach, 0.0);
        self.next = self.reach as u64 * u64::from(self.to);
        (self.taken, self.given) = (0, 0);
    }

    fn run(&mut self, most: u64, resampled: &mut Vec<f32>) {
        let to = u64::from(self.to);
        while self.given < most {
            let (place, part) = ((self.next / to) as usize, self.next % to);
            let Some(samples) = self.pending.get(place - self.reach..place + self.reach + 1) else { break };
            let first = (part / self.stride) as usize * samples.len();
            resampled.push(match self.weights.get(first..first + samples.len()) {
                Some(weights) => product(weights, samples),
                None => {
                    let place = part as f64 / f64::from(self.to) + self.reach as f64;
                    let weighted =
                        |(at, sample): (usize, &f32)| self.kernel.weight(at as f64 - place) * sample;
                    samples.iter().enumerate().map(weighted).sum()
                }
            });
            self.next += u64::from(self.from);
            self.given += 1;
        }
        let passed = ((self.next / to) as usize).saturating_sub(self.reach).min(self.pending.len());
        self.pending.drain(..passed);
        self.next -= passed as u64 * to;
    }
}

/// Returns the sum of products, computed in eight lanes.
fn product(a: &[f32], b: &[f32]) -> f32 {
    let (a, b) = (a.as_chunks::<8>(), b.as_chunks::<8>());
    let mut sums = [0.0; 8];
    for (a, b) in a.0.iter().zip(b.0) {
        sums.iter_mut().zip(a.iter().zip(b)).for_each(|(sum, (a, b))| *sum += a * b);
    }
    sums.iter().sum::<f32>() + a.1.iter().zip(b.1).map(|(a, b)| a * b).sum::<f32>()
}

/// Returns the greatest common divisor.
fn divisor(a: u32, b: u32) -> u32 {
    if b == 0 { a.max(1) } else { divisor(b, a % b) }
}

/// Resamples a whole recording; the number of samples is the duration times the new rate, rounded up.
///
/// # Errors
/// As [`Resampler::new`].
pub fn resampled(samples: &[f32], from: u32, to: u32) -> Result<Vec<f32>> {
    let mut resampler = Resampler::new(from, to)?;
    let mut resampled = Vec::new();
    resampler.push(samples, &mut resampled);
    resampler.finish(&mut resampled);
    Ok(resampled)
}

/// Modified Bessel function of the first kind and order zero.
fn bessel(x: f64) -> f64 {
    let (mut sum, mut term) = (1.0, 1.0);
    for order in 1..64 {
        term *= (x / (2.0 * f64::from(order))).powi(2);
        sum += term;
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tone(hz: f64, rate: u32, seconds: f64) -> Vec<f32> {
        let count = (seconds * f64::from(rate)) as usize;
        (0..count).map(|at| (2.0 * PI * hz * at as f64 / f64::from(rate)).sin() as f32).collect()
    }

    #[test]
    fn tones_keep_pitch_and_volume() {
        for (from, to) in
            [(48_000, 16_000), (44_100, 16_000), (8000, 16_000), (22_050, 16_000), (44_101, 16_000)]
        {
            let output = resampled(&tone(1000.0, from, 0.5), from, to).unwrap();
            let expected = tone(1000.0, to, 0.5);
            assert!(output.len() - expected.len() <= 1, "{from} to {to}");
            let middle = 2000..output.len() - 2000;
            let off = output[middle.clone()].iter().zip(&expected[middle]).map(|(a, b)| (a - b).abs());
            let off = off.fold(0.0, f32::max);
            assert!(off < 2e-3, "{from} to {to}: {off}");
        }
    }

    #[test]
    fn frequencies_above_the_lower_nyquist_rate_are_removed() {
        let output = resampled(&tone(11_000.0, 48_000, 0.5), 48_000, 16_000).unwrap();
        let loudest = output[1000..7000].iter().copied().fold(0.0, f32::max);
        assert!(loudest < 3e-4, "{loudest}");
    }

    #[test]
    fn pieces_yield_the_samples_of_the_whole() {
        let sound = tone(440.0, 44_100, 0.2);
        let whole = resampled(&sound, 44_100, 16_000).unwrap();
        let mut resampler = Resampler::new(44_100, 16_000).unwrap();
        for size in [1, 7, 441, 5000] {
            let mut pieces = Vec::new();
            sound.chunks(size).for_each(|piece| resampler.push(piece, &mut pieces));
            assert!(resampler.pending.len() < 1000);
            resampler.finish(&mut pieces);
            assert!(pieces == whole, "pieces of {size}");
        }
        assert_eq!(resampled(&[0.5, 0.25], 16_000, 16_000).unwrap(), [0.5, 0.25]);
        assert!(resampled(&[], 8000, 16_000).unwrap().is_empty());
    }

    #[test]
    fn invalid_rates_are_refused() {
        for (from, to) in [(0, 16_000), (999, 16_000), (16_000, u32::MAX)] {
            assert!(Resampler::new(from, to).is_err());
        }
    }
}
