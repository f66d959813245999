//! Log-mel spectrogram, the input of Whisper.

use opendr_audio::mfcc::{Mfcc, MfccOptions};
use opendr_engine::Result;

/// Sample rate in Hz.
pub const RATE: u32 = 16_000;
/// Samples per frame: 10 ms.
pub const HOP: usize = 160;
/// Frames per window: 30 s.
pub const WINDOW: usize = 3000;

/// Computes log-mel spectrograms.
pub struct SpectrogramMaker {
    mel: Mfcc,
    bands: usize,
}

/// Spectrogram of a whole recording: `[frames, bands]`.
#[derive(Debug, Default)]
pub struct Spectrogram {
    bands: Vec<f32>,
    pub frames: usize,
    padded: Vec<f32>,
}

impl SpectrogramMaker {
    /// Creates the transform for `bands` mel bands.
    ///
    /// # Errors
    /// `InvalidParam` for an invalid number of bands.
    pub fn new(bands: usize) -> Result<Self> {
        Ok(Self { mel: Mfcc::new(MfccOptions::whisper(bands))?, bands })
    }

    /// Computes the complete frames of audio at [`RATE`]; the audio is padded with silence.
    pub fn run_into(&self, samples: &[f32], spectrogram: &mut Spectrogram) {
        let Spectrogram { bands, frames, padded } = spectrogram;
        padded.clear();
        padded.extend_from_slice(samples);
        padded.resize(samples.len() + self.mel.options().window, 0.0);
        *frames = samples.len() / HOP;
        self.mel.log_mel_into(padded, bands);
        bands.truncate(*frames * self.bands);
        // Decibels are ten times the logarithm.
        bands.iter_mut().for_each(|band| *band = *band / 40.0 + 1.0);
    }

    /// Replaces `window` by the network's input `[bands, WINDOW]`: the frames from `first` on, padded with zeros.
    pub fn window_into(&self, spectrogram: &Spectrogram, first: usize, window: &mut Vec<f32>) {
        window.clear();
        window.resize(self.bands * WINDOW, 0.0);
        let frames = spectrogram.bands.chunks_exact(self.bands.max(1)).skip(first).take(WINDOW);
        for (place, frame) in frames.enumerate() {
            let places = window.iter_mut().skip(place).step_by(WINDOW);
            places.zip(frame).for_each(|(place, band)| *place = *band);
        }
    }
}
