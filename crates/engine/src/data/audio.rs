//! Audio.

use std::borrow::Cow;
use std::fmt;
use std::sync::Arc;

use crate::data::{Array, Data};
use crate::{Error, Header, Result};

/// Audio `[time, channels]`, each sample in [-1, 1].
#[derive(Debug, Clone, PartialEq)]
pub struct Audio {
    /// Time stamp of the first sample, and coordinate frame.
    pub header: Header,
    array: Array<2>,
    sample_rate: u32,
}

impl Audio {
    /// Creates audio over `data` with interleaved channels, at `sample_rate` Hz.
    ///
    /// # Errors
    /// Returns `InvalidInput` if there is no sample or channel, the rate is 0, or a channel lacks samples.
    pub fn new(data: impl Into<Arc<Vec<f32>>>, channels: usize, sample_rate: u32) -> Result<Self> {
        let data = data.into();
        if data.is_empty() {
            return Err(Error::invalid_input("Audio is empty"));
        }
        if channels == 0 || sample_rate == 0 || data.len() % channels != 0 {
            return Err(Error::invalid_input(format!(
                "{} samples are not audio of {channels} channels at {sample_rate} Hz; give equally many for each channel",
                data.len()
            )));
        }
        let shape = [data.len() / channels, channels];
        Ok(Self { header: Header::default(), array: Array::new(data, shape)?, sample_rate })
    }

    /// Creates audio from unsigned 8-bit PCM.
    ///
    /// # Errors
    /// As [`Audio::new`].
    pub fn from_pcm8(samples: &[u8], channels: usize, sample_rate: u32) -> Result<Self> {
        let data: Vec<_> = samples.iter().map(|sample| (f32::from(*sample) - 128.0) / 128.0).collect();
        Self::new(data, channels, sample_rate)
    }

    /// Creates audio from signed 16-bit PCM.
    ///
    /// # Errors
    /// As [`Audio::new`].
    pub fn from_pcm16(samples: &[i16], channels: usize, sample_rate: u32) -> Result<Self> {
        let data: Vec<_> = samples.iter().map(|sample| f32::from(*sample) / 32768.0).collect();
        Self::new(data, channels, sample_rate)
    }

    /// Sets the header.
    #[must_use]
    pub fn with_header(mut self, header: Header) -> Self {
        self.header = header;
        self
    }

    /// Returns the samples as an array.
    pub fn array(&self) -> &Array<2> {
        &self.array
    }

    /// Returns the samples with interleaved channels.
    pub fn as_slice(&self) -> &[f32] {
        self.array.as_slice()
    }

    /// Returns the number of channels.
    pub fn channels(&self) -> usize {
        self.array.shape()[1]
    }

    /// Returns the sampling rate in Hz.
    pub fn sample_rate(&self) -> u32 {
        self.sample_rate
    }

    /// Returns the duration in seconds.
    pub fn duration_s(&self) -> f64 {
        self.array.shape()[0] as f64 / f64::from(self.sample_rate)
    }

    /// Returns the mean of the channels; copies nothing if there is only one.
    pub fn mono(&self) -> Cow<'_, [f32]> {
        let channels = self.channels();
        if channels == 1 {
            return Cow::Borrowed(self.as_slice());
        }
        let frames = self.as_slice().chunks_exact(channels);
        frames.map(|frame| frame.iter().sum::<f32>() / channels as f32).collect()
    }
}

impl Data for Audio {}

/// Writes the samples as NumPy prints them; with `{:#}`, duration, channels and rate.
impl fmt::Display for Audio {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if f.alternate() {
            let (seconds, channels, rate) = (self.duration_s(), self.channels(), self.sample_rate);
            return writeln!(f, "Audio of {seconds:.3} s, {channels} channels at {rate} Hz");
        }
        self.array.fmt(f)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pcm_spans_minus_one_to_one() {
        let audio = Audio::from_pcm8(&[0, 128, 64, 255], 2, 2).unwrap();
        assert_eq!(audio.as_slice(), [-1.0, 0.0, -0.5, 127.0 / 128.0]);
        assert_eq!(*audio.mono(), [-0.5, 63.0 / 256.0]);
        assert_eq!(audio.duration_s(), 1.0);
        let audio = Audio::from_pcm16(&[-32768, 16384], 1, 16_000).unwrap();
        assert_eq!(*audio.mono(), [-1.0, 0.5]);
        assert_eq!(format!("{audio:#}"), "Audio of 0.000 s, 1 channels at 16000 Hz\n");
        assert_eq!(audio.to_string(), "[[-1. ]\n [ 0.5]]");
    }

    #[test]
    fn incomplete_audio_is_rejected() {
        for (count, channels, rate) in [(0, 1, 8000), (3, 2, 8000), (2, 0, 8000), (2, 1, 0)] {
            assert!(Audio::new(vec![0.0; count], channels, rate).is_err());
        }
    }
}
