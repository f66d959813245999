//! Sound as Whisper is given it.

use opendr_engine::Result;
use opendr_sound::mfcc::{Mfcc, MfccOptions};

/// Samples a second.
pub const RATE: u32 = 16_000;
/// Samples of a frame: 10 ms.
pub const HOP: usize = 160;
/// Frames of a window: 30 s.
pub const WINDOW: usize = 3000;

/// Logarithms of mel bands.
pub struct SpectrogramMaker {
    mel: Mfcc,
    bands: usize,
}

/// A whole sound: `[frames, bands]`.
#[derive(Debug, Default)]
pub struct Spectrogram {
    bands: Vec<f32>,
    pub frames: usize,
    padded: Vec<f32>,
}

impl SpectrogramMaker {
    /// # Errors
    /// `InvalidParam` for a number of bands that cannot be.
    pub fn new(bands: usize) -> Result<Self> {
        Ok(Self { mel: Mfcc::new(MfccOptions::whisper(bands))?, bands })
    }

    /// The frames of a sound at [`RATE`]: those that are whole. After its end there is silence.
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

    /// Replaces `window` by the network's input `[bands, WINDOW]`: the frames from `first` on, and zeros where the sound
    /// is over.
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
