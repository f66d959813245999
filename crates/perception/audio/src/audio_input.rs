//! Input of the learners of audio.

use std::borrow::Cow;

use opendr_engine::data::{Audio, Timeseries};
use opendr_engine::learner::{Inputs, Port, Ports};
use opendr_engine::{Error, Header, Result, ValueRef, ValueType};

/// Audio input: [`Audio`] with its sample rate, or a [`Timeseries`] at the learner's sample rate (as in OpenDR).
#[derive(Debug, Clone, Copy)]
pub enum AudioInput<'a> {
    /// Audio with its sample rate.
    Audio(&'a Audio),
    /// One feature through time, or one row as in OpenDR.
    Series(&'a Timeseries),
}

const PORT: &str = ValueType::Audio.port();
/// Maximum absolute value of a sample; spectra of larger values could overflow.
const LOUDEST: f32 = 1e9;

impl<'a> AudioInput<'a> {
    /// Returns the sample rate of the audio in Hz, or `of_series` for a series.
    pub fn rate(self, of_series: u32) -> u32 {
        match self {
            Self::Audio(audio) => audio.sample_rate(),
            Self::Series(_) => of_series,
        }
    }

    /// Returns the samples of one channel at `sample_rate`.
    ///
    /// # Errors
    /// `InvalidInput` for another sample rate, a series of several features, or a sample that is NaN or beyond 10^9, where
    /// spectra would overflow.
    pub fn samples(self, sample_rate: u32) -> Result<Cow<'a, [f32]>> {
        let samples = match self {
            Self::Audio(audio) if audio.sample_rate() != sample_rate => {
                return Err(Error::invalid_input(format!(
                    "the audio has {} Hz, but the learner requires {sample_rate} Hz; resample it",
                    audio.sample_rate()
                )));
            }
            Self::Audio(audio) => audio.mono(),
            Self::Series(series) if series.shape().contains(&1) => Cow::Borrowed(series.as_slice()),
            Self::Series(series) => {
                let [time, features] = series.shape();
                return Err(Error::invalid_input(format!(
                    "a series of {time} time steps with {features} features is not audio; it must have one feature"
                )));
            }
        };
        let is_bad = |sample: &f32| !(-LOUDEST..=LOUDEST).contains(sample);
        // A count over all samples vectorises; a search would not.
        if samples.iter().map(|sample| u32::from(is_bad(sample))).sum::<u32>() == 0 {
            return Ok(samples);
        }
        let at = samples.iter().position(is_bad).unwrap_or_default();
        Err(Error::invalid_input(format!(
            "sample {at} of the audio is {}; samples must be within -1 and 1",
            samples[at]
        )))
    }
}

impl<'a> Inputs<'a> for AudioInput<'a> {
    const PORTS: &'static [Port] = &[Port {
        name: PORT,
        doc: "Audio; a Timeseries of one feature has the learner's sample rate.",
        value_type: ValueType::Audio,
        optional: false,
        init: false,
    }];

    fn from_ports(ports: &Ports<'a>) -> Result<Self> {
        match ports.get(PORT) {
            Some(ValueRef::Timeseries(series)) => Ok(Self::Series(series)),
            _ => ports.required(PORT).map(Self::Audio),
        }
    }

    fn header(&self) -> &Header {
        match self {
            Self::Audio(audio) => &audio.header,
            Self::Series(series) => &series.header,
        }
    }
}

impl<'a> From<&'a Audio> for AudioInput<'a> {
    fn from(audio: &'a Audio) -> Self {
        Self::Audio(audio)
    }
}

impl<'a> From<&'a Timeseries> for AudioInput<'a> {
    fn from(series: &'a Timeseries) -> Self {
        Self::Series(series)
    }
}

#[cfg(test)]
mod tests {
    use opendr_engine::ErrorKind;

    use super::*;

    #[test]
    fn audio_and_series_yield_samples() {
        let audio = Audio::new(vec![0.0, 0.5, 1.0, 0.5], 2, 16_000).unwrap();
        let column = Timeseries::new(vec![0.25, 0.75], [2, 1]).unwrap();
        let row = Timeseries::new(vec![0.25, 0.75], [1, 2]).unwrap();
        for sound in [AudioInput::from(&audio), AudioInput::from(&column), AudioInput::from(&row)] {
            assert_eq!(*sound.samples(16_000).unwrap(), [0.25, 0.75]);
        }
        assert_eq!(AudioInput::from(&audio).samples(8000).unwrap_err().kind(), ErrorKind::InvalidInput);
        let wide = Timeseries::new(vec![0.0; 4], [2, 2]).unwrap();
        assert!(AudioInput::from(&wide).samples(16_000).is_err());
        let broken = Timeseries::new(vec![0.0, f32::NAN], [2, 1]).unwrap();
        assert!(AudioInput::from(&broken).samples(16_000).is_err());
        let Ok(AudioInput::Series(_)) = AudioInput::from_ports(&Ports::default().with("audio", &row)) else {
            panic!()
        };
        assert!(AudioInput::from_ports(&Ports::default()).is_err());
    }
}
