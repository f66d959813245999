//! What cepstra are made of.

use opendr_engine::{Error, Result};
use opendr_kernels::Spectrum;

/// The recipe of an [`Mfcc`](crate::mfcc::Mfcc).
#[derive(Debug, Clone, PartialEq)]
pub struct MfccOptions {
    /// Samples a second.
    pub sample_rate: u32,
    /// Samples that the window (Hann, periodic) of a frame spans.
    pub window: usize,
    /// Samples from one frame to the next.
    pub hop: usize,
    /// Points of the Fourier transform, an even number of at least `window`; what the window does not span is zero.
    pub fft: usize,
    /// Where frames lie.
    pub edges: Edges,
    /// What the mel bands sum.
    pub spectrum: Spectrum,
    /// The mel bands.
    pub bands: MelBands,
    /// How the sums of the bands are compressed.
    pub log: Log,
    /// How the cosine transform (DCT-II) is scaled.
    pub scale: CosineScale,
    /// Coefficients of a frame that are kept, from the first.
    pub coefficients: usize,
}

/// Where frames lie.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Edges {
    /// Only where they fit into the sound: `1 + (samples - window) / hop` frames.
    Inside,
    /// The middle of frame `i` is sample `i * hop`; before its begin and after its end the sound is reflected
    /// (`librosa` with `center=True, pad_mode="reflect"`): `1 + samples / hop` frames.
    Reflected,
    /// As `Reflected`, with silence before its begin and after its end.
    Silent,
}

/// Overlapping triangles, evenly spaced on a mel scale.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MelBands {
    /// How many.
    pub count: usize,
    /// Where the first begins, Hz.
    pub low_hz: f64,
    /// Where the last ends, Hz.
    pub high_hz: f64,
    /// The scale on which they are evenly spaced.
    pub scale: MelScale,
    /// Over which axis the sides of the triangles are straight.
    pub sides: Sides,
    /// Whether each is scaled to an area of one over frequency (`norm="slaney"`) rather than to a height of one.
    pub unit_area: bool,
}

/// Pitch as it is heard, against frequency.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MelScale {
    /// Slaney's Auditory Toolbox: linear up to 1000 Hz, logarithmic above.
    Slaney,
    /// HTK and O'Shaughnessy: `1127 ln(1 + f / 700)`.
    Htk,
}

/// Over which axis the sides of a triangle are straight.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Sides {
    /// Over frequency, as in librosa and torchaudio.
    Hertz,
    /// Over the mel scale, as in TensorFlow, which also leaves the constant part out.
    Mel,
}

/// How the sums of the bands are compressed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Log {
    /// `ln(sum + offset)`.
    Natural {
        /// What keeps silence finite.
        offset: f32,
    },
    /// `10 log10(max(sum, least))`, and nothing further than `range` below the loudest band of the whole sound
    /// (`librosa.power_to_db` with `ref=1`).
    Decibel {
        /// The least sum.
        least: f32,
        /// dB; `None` keeps everything.
        range: Option<f32>,
    },
}

/// How the cosine transform (DCT-II) of `n` bands is scaled.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CosineScale {
    /// `sqrt(2 / n)`, and `sqrt(1 / n)` for the first coefficient: `norm="ortho"` of SciPy and librosa.
    Orthonormal,
    /// `sqrt(2 / n)` for all: TensorFlow's `mfccs_from_log_mel_spectrograms`.
    Uniform,
}

/// Most samples of a window, points of a transform, bands or coefficients.
const MOST: usize = 1 << 16;

impl MfccOptions {
    /// The recipe of TensorFlow's keyword spotting (TinyML, DS-CNN): 40 bands from 20 to 4000 Hz of 30 ms every 20 ms,
    /// ten coefficients. The sound is brought to its [peak](crate::mfcc::peak_factor).
    pub fn keywords() -> Self {
        Self {
            sample_rate: 16_000,
            window: 480,
            hop: 320,
            fft: 512,
            edges: Edges::Inside,
            spectrum: Spectrum::Magnitude,
            bands: MelBands {
                count: 40,
                low_hz: 20.0,
                high_hz: 4000.0,
                scale: MelScale::Htk,
                sides: Sides::Mel,
                unit_area: false,
            },
            log: Log::Natural { offset: 1e-6 },
            scale: CosineScale::Uniform,
            coefficients: 10,
        }
    }

    /// `librosa.feature.mfcc(y, sr=sample_rate, n_mfcc=coefficients, n_fft=window, hop_length=hop, pad_mode="reflect")`:
    /// librosa's defaults, with the reflection that was its default before 0.10.
    pub fn librosa(sample_rate: u32, window: usize, hop: usize, coefficients: usize) -> Self {
        Self {
            sample_rate,
            window,
            hop,
            fft: window,
            edges: Edges::Reflected,
            spectrum: Spectrum::Power,
            bands: MelBands {
                count: 128,
                low_hz: 0.0,
                high_hz: f64::from(sample_rate) / 2.0,
                scale: MelScale::Slaney,
                sides: Sides::Hertz,
                unit_area: true,
            },
            log: Log::Decibel { least: 1e-10, range: Some(80.0) },
            scale: CosineScale::Orthonormal,
            coefficients,
        }
    }

    /// The bands of Whisper's spectrogram in decibels, from `librosa.filters.mel(sr=16000, n_fft=400, n_mels=bands)`:
    /// 25 ms every 10 ms. Whisper takes them [before](crate::mfcc::Mfcc::log_mel_into) the cosine transform.
    pub fn whisper(bands: usize) -> Self {
        let librosa = Self::librosa(16_000, 400, 160, 1);
        Self { bands: MelBands { count: bands, ..librosa.bands }, ..librosa }
    }

    pub(super) fn check(&self) -> Result<()> {
        let sizes = [
            ("window", self.window),
            ("hop", self.hop),
            ("fft", self.fft),
            ("bands", self.bands.count),
            ("coefficients", self.coefficients),
        ];
        for (name, size) in sizes {
            if !(1..=MOST).contains(&size) {
                return Err(Error::invalid_param(format!("{name} = {size} of an MFCC: give 1 to {MOST}")));
            }
        }
        if self.fft < self.window || !self.fft.is_multiple_of(2) {
            let (fft, window) = (self.fft, self.window);
            return Err(Error::invalid_param(format!(
                "a transform of {fft} points for a window of {window} samples; give an even number, at least as many"
            )));
        }
        if self.coefficients > self.bands.count {
            let (coefficients, bands) = (self.coefficients, self.bands.count);
            return Err(Error::invalid_param(format!(
                "{coefficients} coefficients of {bands} bands; give at least as many bands"
            )));
        }
        let MelBands { low_hz, high_hz, .. } = self.bands;
        let highest = f64::from(self.sample_rate) / 2.0;
        if !(0.0 <= low_hz && low_hz < high_hz && high_hz <= highest) {
            return Err(Error::invalid_param(format!(
                "mel bands from {low_hz} to {high_hz} Hz; give frequencies that rise within 0 and {highest} Hz"
            )));
        }
        Ok(())
    }
}
