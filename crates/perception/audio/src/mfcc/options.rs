//! Options of the cepstra.

use opendr_engine::{Error, Result};
use opendr_kernels::Spectrum;

/// Options of an [`Mfcc`](crate::mfcc::Mfcc).
#[derive(Debug, Clone, PartialEq)]
pub struct MfccOptions {
    /// Sample rate in Hz.
    pub sample_rate: u32,
    /// Length of a frame's window (Hann, periodic) in samples.
    pub window: usize,
    /// Distance between frames in samples.
    pub hop: usize,
    /// Points of the Fourier transform, an even number of at least `window`; samples outside the window are zero.
    pub fft: usize,
    /// Position of the frames.
    pub edges: Edges,
    /// Spectrum that the mel bands sum.
    pub spectrum: Spectrum,
    /// The mel bands.
    pub bands: MelBands,
    /// Compression of the bands' sums.
    pub log: Log,
    /// Scaling of the cosine transform (DCT-II).
    pub scale: CosineScale,
    /// Number of coefficients per frame, from the first.
    pub coefficients: usize,
}

/// Position of the frames and padding.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Edges {
    /// Frames within the audio only: `1 + (samples - window) / hop` frames.
    Inside,
    /// Frame `i` is centred on sample `i * hop`; the audio is padded by reflection (`librosa` with
    /// `center=True, pad_mode="reflect"`): `1 + samples / hop` frames.
    Reflected,
    /// As `Reflected`, but padded with silence.
    Silent,
}

/// Mel bands: overlapping triangular filters, evenly spaced on a mel scale.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MelBands {
    /// Number of bands.
    pub count: usize,
    /// Start of the first band in Hz.
    pub low_hz: f64,
    /// End of the last band in Hz.
    pub high_hz: f64,
    /// Scale on which the bands are evenly spaced.
    pub scale: MelScale,
    /// Axis on which the sides of the triangles are straight.
    pub sides: Sides,
    /// Whether each band is scaled to unit area over frequency (`norm="slaney"`), else to unit height.
    pub unit_area: bool,
}

/// Mel scale: perceived pitch as a function of frequency.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MelScale {
    /// Slaney's Auditory Toolbox: linear up to 1000 Hz, logarithmic above.
    Slaney,
    /// HTK and O'Shaughnessy: `1127 ln(1 + f / 700)`.
    Htk,
}

/// Axis on which the sides of a triangle are straight.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Sides {
    /// Over frequency, as in librosa and torchaudio.
    Hertz,
    /// Over the mel scale, as in TensorFlow, which also omits the constant component.
    Mel,
}

/// Compression of the bands' sums.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Log {
    /// `ln(sum + offset)`.
    Natural {
        /// Offset that keeps silence finite.
        offset: f32,
    },
    /// `10 log10(max(sum, least))`, limited to `range` below the loudest band of the whole recording (`librosa.power_to_db`
    /// with `ref=1`).
    Decibel {
        /// Minimum sum.
        least: f32,
        /// Range in dB; `None` for no limit.
        range: Option<f32>,
    },
}

/// Scaling of the cosine transform (DCT-II) of `n` bands.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CosineScale {
    /// `sqrt(2 / n)`, and `sqrt(1 / n)` for the first coefficient: `norm="ortho"` of SciPy and librosa.
    Orthonormal,
    /// `sqrt(2 / n)` for all: TensorFlow's `mfccs_from_log_mel_spectrograms`.
    Uniform,
}

/// Maximum of window, transform size, bands and coefficients.
const MOST: usize = 1 << 16;

impl MfccOptions {
    /// Returns the options of TensorFlow's keyword spotting (TinyML, DS-CNN): 40 bands from 20 to 4000 Hz of 30 ms every 20 ms,
    /// ten coefficients. The audio is first normalised by its [peak](crate::mfcc::peak_factor).
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

    /// Returns the options of
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

    /// Returns the options of Whisper's spectrogram in decibels, with the bands of
    /// `librosa.filters.mel(sr=16000, n_fft=400, n_mels=bands)`: 25 ms every 10 ms. Whisper uses the bands
    /// [before](crate::mfcc::Mfcc::log_mel_into) the cosine transform.
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
                return Err(Error::invalid_param(format!(
                    "{name} = {size} of an MFCC is out of range; use 1 to {MOST}"
                )));
            }
        }
        if self.fft < self.window || !self.fft.is_multiple_of(2) {
            let (fft, window) = (self.fft, self.window);
            return Err(Error::invalid_param(format!(
                "fft = {fft} is invalid for a window of {window} samples; use an even number of at least {window}"
            )));
        }
        if self.coefficients > self.bands.count {
            let (coefficients, bands) = (self.coefficients, self.bands.count);
            return Err(Error::invalid_param(format!(
                "{coefficients} coefficients need at least as many bands, not {bands}"
            )));
        }
        let MelBands { low_hz, high_hz, .. } = self.bands;
        let highest = f64::from(self.sample_rate) / 2.0;
        if !(0.0 <= low_hz && low_hz < high_hz && high_hz <= highest) {
            return Err(Error::invalid_param(format!(
                "mel bands from {low_hz} to {high_hz} Hz are invalid; use increasing frequencies within 0 and {highest} Hz"
            )));
        }
        Ok(())
    }
}
