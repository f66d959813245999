//! Sound at another rate.
//!
//! Windowed sinc interpolation (Smith, Digital Audio Resampling, 1984) with a Kaiser window of 32 zero crossings on each
//! side: what lies above 0.93 of half the lower rate fades, what would be mirrored is some 80 dB down. A stream in pieces
//! gives what it gives in one.

use std::f64::consts::PI;

use opendr_engine::{Error, Result};

/// Zero crossings on each side.
const ZEROS: usize = 32;
/// Entries of the table between two of them.
const STEPS: usize = 512;
/// Of half the lower rate, what passes.
const ROLL_OFF: f64 = 0.93;
/// The Kaiser window's.
const BETA: f64 = 9.0;

/// Weights that are kept rather than made anew for each output.
const MOST_WEIGHTS: usize = 1 << 17;

/// The rates that there are, Hz.
const RATES: std::ops::RangeInclusive<u32> = 1000..=768_000;

/// Changes the rate of one stream of sound.
#[derive(Debug)]
pub struct Resampler {
    from: u32,
    to: u32,
    kernel: Kernel,
    /// Weights of the samples around an output, for each of the places between two samples that there are; empty where
    /// these are many.
    weights: Vec<f32>,
    /// Parts of a sample, `to` to one, from one such place to the next.
    stride: u64,
    /// Samples on each side that an output depends on.
    reach: usize,
    pending: Vec<f32>,
    /// Where the next output lies behind the first of `pending`, in parts of a sample, `to` to one.
    next: u64,
    taken: u64,
    given: u64,
}

/// Half of the windowed sinc, `STEPS` entries a zero crossing, scaled.
#[derive(Debug)]
struct Kernel {
    table: Vec<f32>,
    /// Entries that a sample spans.
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

    /// The weight of a sample at a distance, samples.
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
    /// From `from` to `to` samples a second.
    ///
    /// # Errors
    /// `InvalidInput` for a rate outside of 1,000 to 768,000 Hz.
    pub fn new(from: u32, to: u32) -> Result<Self> {
        if let Some(rate) = [from, to].iter().find(|rate| !RATES.contains(rate)) {
            return Err(Error::invalid_input(format!(
                "sound at {rate} Hz cannot be resampled; give {} to {} Hz",
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

    /// The rate of what it takes, Hz.
    pub fn from_rate(&self) -> u32 {
        self.from
    }

    /// Takes the next piece, and adds what follows from it to `resampled`.
    pub fn push(&mut self, piece: &[f32], resampled: &mut Vec<f32>) {
        self.taken += piece.len() as u64;
        if self.from == self.to {
            resampled.extend_from_slice(piece);
            return;
        }
        self.pending.extend_from_slice(piece);
        self.run(u64::MAX, resampled);
    }

    /// The stream is over: adds the rest, so that in all there are as many samples as it lasted, rounded up.
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

/// The sum of products, eight side by side.
fn product(a: &[f32], b: &[f32]) -> f32 {
    let (a, b) = (a.as_chunks::<8>(), b.as_chunks::<8>());
    let mut sums = [0.0; 8];
    for (a, b) in a.0.iter().zip(b.0) {
        sums.iter_mut().zip(a.iter().zip(b)).for_each(|(sum, (a, b))| *sum += a * b);
    }
    sums.iter().sum::<f32>() + a.1.iter().zip(b.1).map(|(a, b)| a * b).sum::<f32>()
}

/// The greatest number that divides both.
fn divisor(a: u32, b: u32) -> u32 {
    if b == 0 { a.max(1) } else { divisor(b, a % b) }
}

/// A whole sound at another rate, in as many samples as it lasts, rounded up.
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

/// The modified Bessel function of the first kind and order zero.
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
    fn tones_keep_their_pitch_and_loudness() {
        for (from, to) in
            [(48_000, 16_000), (44_100, 16_000), (8000, 16_000), (22_050, 16_000), (44_101, 16_000)]
        {
            let heard = resampled(&tone(1000.0, from, 0.5), from, to).unwrap();
            let wanted = tone(1000.0, to, 0.5);
            assert!(heard.len() - wanted.len() <= 1, "{from} to {to}");
            let middle = 2000..heard.len() - 2000;
            let off = heard[middle.clone()].iter().zip(&wanted[middle]).map(|(a, b)| (a - b).abs());
            let off = off.fold(0.0, f32::max);
            assert!(off < 2e-3, "{from} to {to}: {off}");
        }
    }

    #[test]
    fn what_the_lower_rate_cannot_carry_is_gone() {
        let heard = resampled(&tone(11_000.0, 48_000, 0.5), 48_000, 16_000).unwrap();
        let loudest = heard[1000..7000].iter().copied().fold(0.0, f32::max);
        assert!(loudest < 3e-4, "{loudest}");
    }

    #[test]
    fn pieces_give_what_the_whole_gives() {
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
    fn rates_that_cannot_be_are_refused() {
        for (from, to) in [(0, 16_000), (999, 16_000), (16_000, u32::MAX)] {
            assert!(Resampler::new(from, to).is_err());
        }
    }
}
