//! Input of the network from audio and video.

use opendr_audio::mfcc::{Mfcc, MfccOptions};
use opendr_audio::{AudioInput, standardise};
use opendr_engine::data::{Audio, Video};
use opendr_engine::{Pool, Result};
use opendr_perception_common::clip_frames::ClipFrames;

use super::params::AudiovisualEmotionParams;

/// Sizes of the network's input.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Sizes {
    /// Number of frames of the face.
    pub frames: usize,
    /// Side of a frame in pixels.
    pub side: usize,
    /// Number of time steps of the cepstra.
    pub instants: usize,
    /// Sample rate of the audio in Hz.
    pub sample_rate: u32,
    /// Number of samples that are used.
    pub samples: usize,
}

/// Window and hop of the cepstra in samples, librosa's defaults.
const WINDOW: usize = 2048;
const HOP: usize = 512;

impl Sizes {
    /// Number of coefficients per time step.
    pub const COEFFICIENTS: usize = 10;

    /// Returns the sizes with faces of `side` x `side` pixels.
    pub fn new(params: &AudiovisualEmotionParams, side: usize) -> Self {
        let samples = (params.seconds * f64::from(params.sample_rate)).round() as usize;
        let (frames, sample_rate) = (params.seq_length, params.sample_rate);
        Self { frames, side, instants: 1 + samples / HOP, sample_rate, samples }
    }

    /// Returns the number of values of an audio input.
    pub fn audio(&self) -> usize {
        Self::COEFFICIENTS * self.instants
    }

    /// Returns the number of values of a video input.
    pub fn video(&self) -> usize {
        self.frames * 3 * self.side * self.side
    }
}

/// Computes the network's inputs.
pub(super) struct FrontEnd {
    pub sizes: Sizes,
    mfcc: Mfcc,
    frames: ClipFrames,
    cepstra: Pool<Vec<f32>>,
}

impl FrontEnd {
    /// Creates the front end for a network of these sizes.
    ///
    /// # Errors
    /// As [`Mfcc::new`].
    pub fn new(sizes: &Sizes) -> Result<Self> {
        let mfcc = Mfcc::new(MfccOptions::librosa(sizes.sample_rate, WINDOW, HOP, Sizes::COEFFICIENTS))?;
        let frames = ClipFrames::new(sizes.side, sizes.frames);
        Ok(Self { sizes: *sizes, mfcc, frames, cepstra: Pool::default() })
    }

    /// Replaces `input` by cepstra `[coefficients, time steps]`, each coefficient normalised to zero mean and unit deviation
    /// over time; silence and padding are zeros.
    ///
    /// # Errors
    /// `InvalidInput` for audio of another sample rate, or a sample that is NaN.
    pub fn audio_into(&self, audio: &Audio, input: &mut Vec<f32>) -> Result<()> {
        let samples = AudioInput::from(audio).samples(self.sizes.sample_rate)?;
        let samples = samples.get(..self.sizes.samples).unwrap_or(&samples);
        let cepstra = &mut *self.cepstra.take();
        let count = self.mfcc.run_into(samples, cepstra).min(self.sizes.instants);
        input.clear();
        input.resize(self.sizes.audio(), 0.0);
        for (coefficient, row) in input.chunks_exact_mut(self.sizes.instants).enumerate() {
            let known = row.iter_mut().zip(cepstra.iter().skip(coefficient).step_by(Sizes::COEFFICIENTS));
            known.for_each(|(place, value)| *place = *value);
            standardise(&mut row[..count]);
        }
        Ok(())
    }

    /// Replaces `input` by frames `[frames, 3, side, side]`; zeros without a video.
    ///
    /// # Errors
    /// As [`ClipFrames::clip_into`].
    pub fn video_into(&self, video: Option<&Video>, input: &mut Vec<f32>) -> Result<()> {
        if let Some(video) = video {
            return self.frames.clip_into(video, input);
        }
        input.clear();
        input.resize(self.sizes.video(), 0.0);
        Ok(())
    }
}
