//! Mel-frequency cepstral coefficients (MFCC), the input of speech networks.
//!
//! Davis and Mermelstein, Comparison of Parametric Representations for Monosyllabic Word Recognition, 1980. Implementations
//! differ in every detail, and a network needs the one it was trained with: [`MfccOptions`] selects it, and reproduces
//! TensorFlow and librosa up to rounding.
//!
//! ```
//! use opendr_audio::mfcc::{Mfcc, MfccOptions};
//!
//! let mfcc = Mfcc::new(MfccOptions::keywords())?;
//! let second = vec![0.1; 16_000];
//! let mut cepstra = Vec::new();
//! let frames = mfcc.run_into(&second, &mut cepstra);
//! assert_eq!((frames, cepstra.len()), (49, 49 * 10));
//! # Ok::<(), opendr_engine::Error>(())
//! ```

mod mel_bank;
mod options;
mod stream;
mod transform;

#[cfg(test)]
mod tests;

use opendr_engine::{Pool, Result};
use opendr_kernels::FOURIER_FRAMES;

pub use opendr_kernels::Spectrum;
pub use options::{CosineScale, Edges, Log, MelBands, MelScale, MfccOptions, Sides};
pub use stream::MfccStream;

use mel_bank::MelBank;
use transform::{CosineTransform, FrameSpectrum, FrameWork};

/// Computes cepstra. Does not allocate after the first recording of a length.
pub struct Mfcc {
    options: MfccOptions,
    spectrum: FrameSpectrum,
    bank: MelBank,
    cosine: CosineTransform,
    work: Pool<Work>,
}

#[derive(Default)]
struct Work {
    frames: FrameWork,
    /// Log-mel bands `[frames, bands]`.
    bands: Vec<f32>,
}

impl Mfcc {
    /// Creates the tables for `options`.
    ///
    /// # Errors
    /// `InvalidParam` for sizes that are zero, too large or inconsistent, or frequencies that do not increase.
    pub fn new(options: MfccOptions) -> Result<Self> {
        options.check()?;
        let MelBands { count, .. } = options.bands;
        Ok(Self {
            spectrum: FrameSpectrum::new(&options),
            bank: MelBank::new(&options.bands, options.fft, options.sample_rate),
            cosine: CosineTransform::new(count, options.coefficients, options.scale),
            work: Pool::default(),
            options,
        })
    }

    /// Returns the options.
    pub fn options(&self) -> &MfccOptions {
        &self.options
    }

    /// Returns the number of frames of `samples` samples of one channel.
    pub fn frames(&self, samples: usize) -> usize {
        match self.options.edges {
            _ if samples == 0 => 0,
            Edges::Inside => {
                samples.checked_sub(self.options.window).map_or(0, |rest| 1 + rest / self.options.hop)
            }
            Edges::Reflected | Edges::Silent => 1 + samples / self.options.hop,
        }
    }

    /// Replaces `cepstra` by those of `samples`, `[frames, coefficients]`, and returns the number of frames.
    pub fn run_into(&self, samples: &[f32], cepstra: &mut Vec<f32>) -> usize {
        self.run_scaled_into(samples, 1.0, cepstra)
    }

    /// Computes as [`Mfcc::run_into`] for samples multiplied by `factor`, a positive number; the factor is applied to the bands and
    /// not to the samples.
    pub fn run_scaled_into(&self, samples: &[f32], factor: f32, cepstra: &mut Vec<f32>) -> usize {
        let Work { frames: work, bands } = &mut *self.work.take();
        let frames = self.log_mel_of(samples, factor, work, bands);
        cepstra.resize(frames * self.options.coefficients, 0.0);
        self.cosine.run(bands, cepstra);
        frames
    }

    /// Replaces `bands` by the log-mel bands, `[frames, bands]`, from which cepstra are computed, and returns the number of
    /// frames.
    pub fn log_mel_into(&self, samples: &[f32], bands: &mut Vec<f32>) -> usize {
        self.log_mel_of(samples, 1.0, &mut self.work.take().frames, bands)
    }

    fn log_mel_of(&self, samples: &[f32], factor: f32, work: &mut FrameWork, bands: &mut Vec<f32>) -> usize {
        let (frames, count) = (self.frames(samples.len()), self.options.bands.count);
        bands.resize(frames * count, 0.0);
        for first in (0..frames).step_by(FOURIER_FRAMES) {
            let together = FOURIER_FRAMES.min(frames - first);
            (0..together).for_each(|lane| self.spectrum.fill(samples, first + lane, lane, work));
            self.log_bands(work, factor, &mut bands[first * count..][..together * count]);
        }
        self.limit_range(bands);
        frames
    }

    /// Writes the log-mel bands of the first frames in `work`, `[frames, bands]`, as if all samples were multiplied by
    /// `factor`.
    fn log_bands(&self, work: &mut FrameWork, factor: f32, bands: &mut [f32]) {
        let count = self.options.bands.count;
        let factor = match self.options.spectrum {
            Spectrum::Magnitude => factor,
            Spectrum::Power => (factor * factor).min(f32::MAX),
        };
        for (band, sums) in self.spectrum.band_sums(&self.bank, work).iter().enumerate() {
            for (bands, sum) in bands.chunks_exact_mut(count).zip(sums) {
                bands[band] = match self.options.log {
                    Log::Natural { offset } => (factor * sum + offset).ln(),
                    Log::Decibel { least, .. } => 10.0 * (factor * sum).max(least).log10(),
                };
            }
        }
    }

    fn limit_range(&self, bands: &mut [f32]) {
        if let Log::Decibel { range: Some(range), .. } = self.options.log {
            let least = bands.iter().copied().fold(f32::NEG_INFINITY, f32::max) - range;
            bands.iter_mut().for_each(|band| *band = band.max(least));
        }
    }
}

/// Returns the factor that normalises the peak of `samples` to 1, as in TensorFlow's keyword spotting, for
/// [`Mfcc::run_scaled_into`]; 1 for silence.
pub fn peak_factor(samples: &[f32]) -> f32 {
    // Lanes that the compiler can vectorise.
    let mut peaks = [0.0_f32; 16];
    let (chunks, rest) = samples.as_chunks::<16>();
    for chunk in chunks.iter().map(|chunk| &chunk[..]).chain([rest]) {
        for (peak, sample) in peaks.iter_mut().zip(chunk) {
            *peak = if *sample > *peak { *sample } else { *peak };
        }
    }
    let peak = peaks.iter().copied().fold(0.0, f32::max);
    if peak > 0.0 { peak.recip().min(f32::MAX) } else { 1.0 }
}
