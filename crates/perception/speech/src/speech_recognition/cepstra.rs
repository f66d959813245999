//! Input of the networks: cepstra of audio.

use opendr_audio::mfcc::{Mfcc, MfccOptions};
use opendr_audio::{AudioInput, standardise};
use opendr_engine::{Error, Pool, Result};

/// Number of frames in the network's input: 1.2 s of audio; longer audio is cut, shorter audio is padded.
pub const FRAMES: usize = 40;

/// MFCC front end of OpenDR's learners: windows of 40 ms every 30 ms, computed as librosa does, normalised to zero mean and
/// unit deviation over the audio. Different from OpenDR, short audio is padded with that mean, not with a value that
/// corresponds to loud noise.
pub struct FrontEnd {
    /// `None` when the input consists of cepstra.
    mfcc: Option<Mfcc>,
    sample_rate: u32,
    coefficients: usize,
    cepstra: Pool<Vec<f32>>,
}

impl FrontEnd {
    /// Creates the front end for audio at `sample_rate` in Hz; with `mfcc` unset, for cepstra `[frames, coefficients]`.
    ///
    /// # Errors
    /// `InvalidParam` for a sample rate that is too low.
    pub fn new(mfcc: bool, sample_rate: u32, coefficients: usize) -> Result<Self> {
        let (window, hop) = (sample_rate as usize / 25, sample_rate as usize * 3 / 100);
        let make = || Mfcc::new(MfccOptions::librosa(sample_rate, window, hop, coefficients));
        Ok(Self { mfcc: mfcc.then(make).transpose()?, sample_rate, coefficients, cepstra: Pool::default() })
    }

    /// Replaces `input` by the network's input, `[coefficients, FRAMES]`.
    ///
    /// # Errors
    /// `InvalidInput` for audio of another sample rate, or (without MFCC) for an input that is no cepstra.
    pub fn input_into(&self, sound: AudioInput<'_>, input: &mut Vec<f32>) -> Result<()> {
        let cepstra = &mut *self.cepstra.take();
        self.cepstra_into(sound, cepstra)?;
        input.clear();
        input.resize(self.coefficients * FRAMES, 0.0);
        for (frame, cepstrum) in cepstra.chunks_exact(self.coefficients).enumerate() {
            let places = input.iter_mut().skip(frame).step_by(FRAMES);
            places.zip(cepstrum).for_each(|(place, coefficient)| *place = *coefficient);
        }
        Ok(())
    }

    /// Replaces `cepstra` by at most [`FRAMES`] frames, each with the number of coefficients given to [`FrontEnd::new`].
    ///
    /// # Errors
    /// As [`FrontEnd::input_into`].
    pub fn cepstra_into(&self, sound: AudioInput<'_>, cepstra: &mut Vec<f32>) -> Result<()> {
        match (&self.mfcc, sound) {
            (Some(mfcc), sound) => {
                mfcc.run_into(&sound.samples(self.sample_rate)?, cepstra);
                cepstra.truncate(FRAMES * self.coefficients);
                standardise(cepstra);
                Ok(())
            }
            (None, AudioInput::Series(series)) if series.shape()[1] == self.coefficients => {
                cepstra.clear();
                cepstra.extend(series.as_slice().iter().take(FRAMES * self.coefficients));
                Ok(())
            }
            (None, _) => {
                let coefficients = self.coefficients;
                Err(Error::invalid_input(format!(
                    "with preprocess_to_mfcc = false the input must be a Timeseries of {coefficients} coefficients per \
                     frame; pass such a series, or audio with preprocess_to_mfcc = true"
                )))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use opendr_engine::data::{Audio, Timeseries};

    use super::*;

    const COEFFICIENTS: usize = 64;

    #[test]
    fn short_audio_is_padded_and_long_audio_cut() {
        let front_end = FrontEnd::new(true, 16_000, COEFFICIENTS).unwrap();
        let noise = |samples: usize| {
            let samples: Vec<f32> = (0..samples).map(|at| ((at * at) as f32 * 0.01).sin()).collect();
            Audio::new(samples, 1, 16_000).unwrap()
        };
        let mut input = Vec::new();
        for (samples, frames) in [(16_000, 34), (40_000, FRAMES), (10, 1)] {
            front_end.input_into((&noise(samples)).into(), &mut input).unwrap();
            let filled = |frame: usize| (0..COEFFICIENTS).any(|row| input[row * FRAMES + frame] != 0.0);
            assert_eq!((0..FRAMES).filter(|frame| filled(*frame)).count(), frames);
            let values = input.iter().filter(|value| **value != 0.0);
            let power: f32 = values.map(|value| value * value).sum();
            assert!((power / (frames * COEFFICIENTS) as f32 - 1.0).abs() < 0.02, "{power}");
        }
        assert!(front_end.input_into((&Audio::new(vec![0.0], 1, 8000).unwrap()).into(), &mut input).is_err());
    }

    #[test]
    fn cepstra_pass_unchanged() {
        let front_end = FrontEnd::new(false, 16_000, COEFFICIENTS).unwrap();
        let numbers: Vec<f32> = (0..2 * COEFFICIENTS).map(|at| at as f32).collect();
        let series = Timeseries::new(numbers, [2, COEFFICIENTS]).unwrap();
        let mut input = Vec::new();
        front_end.input_into((&series).into(), &mut input).unwrap();
        assert_eq!((input[0], input[1], input[2], input[FRAMES]), (0.0, 64.0, 0.0, 1.0));
        let sound = Audio::new(vec![0.0; 16_000], 1, 16_000).unwrap();
        assert!(front_end.input_into((&sound).into(), &mut input).is_err());
    }
}
