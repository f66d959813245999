//! What was said.

use std::fmt;

use serde::{Deserialize, Serialize};

use crate::Header;
use crate::target::Action;
use crate::target::json_number::null_as_nan;

/// What was said. Printed, it is the words.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct BaseTranscription {
    /// Of the sound.
    #[serde(flatten)]
    pub header: Header,
    /// The words.
    pub text: String,
    /// How to move to hear better.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub action: Option<Action>,
}

/// What was said, as a streaming recogniser tells it. Printed, it is the words.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct VoskTranscription {
    /// Of the sound.
    #[serde(flatten)]
    pub header: Header,
    /// The words so far.
    pub text: String,
    /// Whether the phrase is finished: the words will not change any more.
    #[serde(default)]
    pub accept_waveform: bool,
    /// How to move to hear better.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub action: Option<Action>,
}

/// A part of a transcription, as Whisper tells it.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct WhisperSegment {
    /// Number of the segment.
    pub id: i64,
    /// Where its window begins, in frames of the spectrogram (10 ms).
    pub seek: i64,
    /// Begin within the sound, seconds.
    #[serde(deserialize_with = "null_as_nan")]
    pub start: f32,
    /// End within the sound, seconds.
    #[serde(deserialize_with = "null_as_nan")]
    pub end: f32,
    /// The words.
    pub text: String,
    /// The tokens they were made of.
    pub tokens: Vec<i64>,
    /// Sampling temperature.
    #[serde(deserialize_with = "null_as_nan")]
    pub temperature: f32,
    /// Mean log-probability of the tokens.
    #[serde(deserialize_with = "null_as_nan")]
    pub avg_logprob: f32,
    /// Length of the text over its length when packed; high for repetitions.
    #[serde(deserialize_with = "null_as_nan")]
    pub compression_ratio: f32,
    /// Probability that nobody speaks.
    #[serde(deserialize_with = "null_as_nan")]
    pub no_speech_prob: f32,
}

/// What was said, with its parts. Printed, it is the words; `{:#}` gives a line per part.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct WhisperTranscription {
    /// Of the sound.
    #[serde(flatten)]
    pub header: Header,
    /// The words.
    pub text: String,
    /// Its parts in the order of time.
    #[serde(default)]
    pub segments: Vec<WhisperSegment>,
    /// How to move to hear better.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub action: Option<Action>,
}

target!(BaseTranscription, |_| None);
target!(VoskTranscription, |_| None);
target!(WhisperTranscription, |_| None);

impl fmt::Display for BaseTranscription {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write_words(&self.text, f)
    }
}

impl fmt::Display for VoskTranscription {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write_words(&self.text, f)
    }
}

impl fmt::Display for WhisperTranscription {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if !f.alternate() || self.segments.is_empty() {
            return write_words(&self.text, f);
        }
        for WhisperSegment { start, end, text, .. } in &self.segments {
            writeln!(f, "{start:.2} s to {end:.2} s: {}", text.trim())?;
        }
        Ok(())
    }
}

fn write_words(text: &str, f: &mut fmt::Formatter<'_>) -> fmt::Result {
    if f.alternate() { writeln!(f, "{}", text.trim()) } else { f.write_str(text) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texts() {
        let text = " hello robot".to_owned();
        let segment =
            WhisperSegment { start: 0.5, end: 1.25, text: text.clone(), ..WhisperSegment::default() };
        let spoken =
            WhisperTranscription { text, segments: vec![segment], ..WhisperTranscription::default() };
        assert_eq!(spoken.to_string(), " hello robot");
        assert_eq!(format!("{spoken:#}"), "0.50 s to 1.25 s: hello robot\n");
    }
}
