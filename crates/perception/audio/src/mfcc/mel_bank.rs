//! Mel bands: overlapping triangular filters over a spectrum.

use opendr_kernels::FOURIER_FRAMES;

use crate::mfcc::options::{MelBands, MelScale, Sides};

/// One value of each frame of a group that is transformed together.
pub(super) type Frames = [f32; FOURIER_FRAMES];

/// Weights of each band, without the zeros.
pub(super) struct MelBank {
    bands: Vec<Band>,
    weights: Vec<f32>,
}

/// First bin of a band in the spectrum, and the range of its weights.
struct Band {
    bin: usize,
    weights: std::ops::Range<usize>,
}

impl MelBank {
    /// Creates the bands over the `fft / 2 + 1` frequencies of a transform of `fft` points.
    pub fn new(options: &MelBands, fft: usize, sample_rate: u32) -> Self {
        let MelBands { count, low_hz, high_hz, scale, sides, unit_area } = *options;
        let (low, high) = (scale.mel_from_hz(low_hz), scale.mel_from_hz(high_hz));
        let corner_mel = |index: usize| low + (high - low) * index as f64 / (count + 1) as f64;
        let place_from_mel = |mel: f64| match sides {
            Sides::Hertz => scale.hz_from_mel(mel),
            Sides::Mel => mel,
        };
        let place_of_bin = |bin: usize| {
            let hz = bin as f64 * f64::from(sample_rate) / fft as f64;
            match sides {
                Sides::Hertz => hz,
                Sides::Mel => scale.mel_from_hz(hz),
            }
        };
        let first_bin = if sides == Sides::Mel { 1 } else { 0 };
        let mut bank = Self { bands: Vec::with_capacity(count), weights: Vec::new() };
        for band in 0..count {
            let [left, middle, right] = [0, 1, 2].map(|corner| place_from_mel(corner_mel(band + corner)));
            let height = match unit_area {
                true => {
                    let [left, right] = [0, 2].map(|corner| scale.hz_from_mel(corner_mel(band + corner)));
                    2.0 / (right - left)
                }
                false => 1.0,
            };
            let weight = |bin: usize| {
                let place = place_of_bin(bin);
                height * ((place - left) / (middle - left)).min((right - place) / (right - middle)).max(0.0)
            };
            let begin = (first_bin..=fft / 2).find(|bin| weight(*bin) > 0.0).unwrap_or(first_bin);
            let start = bank.weights.len();
            let inside = (begin..=fft / 2).map(weight).take_while(|weight| *weight > 0.0);
            bank.weights.extend(inside.map(|weight| weight as f32));
            bank.bands.push(Band { bin: begin, weights: start..bank.weights.len() });
        }
        bank
    }

    /// Replaces `sums` by the weighted sums of the spectra in each band.
    pub fn sums(&self, spectrum: &[Frames], sums: &mut Vec<Frames>) {
        sums.clear();
        sums.resize(self.bands.len(), Frames::default());
        for (band, sums) in self.bands.iter().zip(sums) {
            let weights = &self.weights[band.weights.clone()];
            for (weight, values) in weights.iter().zip(&spectrum[band.bin..]) {
                sums.iter_mut().zip(values).for_each(|(sum, value)| *sum += weight * value);
            }
        }
    }
}

/// Frequency at which Slaney's scale changes from linear to logarithmic.
const BREAK_HZ: f64 = 1000.0;
/// Width of a mel below `BREAK_HZ`.
const LINEAR_HZ: f64 = 200.0 / 3.0;
/// Number of mels from 1000 Hz to 6400 Hz.
const LOG_MELS: f64 = 27.0;

impl MelScale {
    /// Returns the pitch of a frequency.
    pub fn mel_from_hz(self, hz: f64) -> f64 {
        match self {
            Self::Htk => 1127.0 * (hz / 700.0).ln_1p(),
            Self::Slaney if hz < BREAK_HZ => hz / LINEAR_HZ,
            Self::Slaney => BREAK_HZ / LINEAR_HZ + (hz / BREAK_HZ).ln() * LOG_MELS / 6.4f64.ln(),
        }
    }

    /// Returns the frequency of a pitch.
    pub fn hz_from_mel(self, mel: f64) -> f64 {
        let log_mel = mel - BREAK_HZ / LINEAR_HZ;
        match self {
            Self::Htk => 700.0 * (mel / 1127.0).exp_m1(),
            Self::Slaney if log_mel < 0.0 => mel * LINEAR_HZ,
            Self::Slaney => BREAK_HZ * (log_mel * 6.4f64.ln() / LOG_MELS).exp(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Expected values of `librosa.hz_to_mel`, and of TensorFlow's constants.
    #[test]
    fn pitches() {
        let close = |actual: f64, expected: f64| {
            assert!((actual - expected).abs() < 1e-3, "{actual} is not {expected}")
        };
        close(MelScale::Slaney.mel_from_hz(60.0), 0.9);
        close(MelScale::Slaney.mel_from_hz(6400.0), 42.0);
        close(MelScale::Htk.mel_from_hz(1000.0), 999.9907);
        for scale in [MelScale::Slaney, MelScale::Htk] {
            for hz in [0.0, 440.0, 999.0, 1000.0, 7999.0] {
                close(scale.hz_from_mel(scale.mel_from_hz(hz)), hz);
            }
        }
    }

    #[test]
    fn a_flat_spectrum_yields_equal_bands_of_unit_area() {
        let options = MelBands {
            count: 20,
            low_hz: 0.0,
            high_hz: 8000.0,
            scale: MelScale::Htk,
            sides: Sides::Hertz,
            unit_area: true,
        };
        let bank = MelBank::new(&options, 4096, 16_000);
        let mut sums = Vec::new();
        bank.sums(&[[1.0; FOURIER_FRAMES]; 2049], &mut sums);
        // One over the width of a bin.
        let expected = 4096.0 / 16_000.0;
        assert!(sums.as_flattened().iter().all(|sum| (sum / expected - 1.0).abs() < 0.02), "{sums:?}");
        assert_eq!(sums.len(), 20);
    }
}
