//! Transcriptions of speech.

use std::fmt;

use serde::{Deserialize, Serialize};

use crate::Header;
use crate::target::Action;
use crate::target::json_number::null_as_nan;

/// A transcription. `{}` writes the text.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct BaseTranscription {
    /// Header of the audio.
    #[serde(flatten)]
    pub header: Header,
    /// Recognised text.
    pub text: String,
    /// Proposed motion for better audio.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub action: Option<Action>,
}

/// The transcription of a streaming recogniser. `{}` writes the text.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct VoskTranscription {
    /// Header of the audio.
    #[serde(flatten)]
    pub header: Header,
    /// Text so far.
    pub text: String,
    /// Whether the phrase is finished: its text will not change any more.
    #[serde(default)]
    pub accept_waveform: bool,
    /// Proposed motion for better audio.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub action: Option<Action>,
}

/// A segment of a Whisper transcription.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct WhisperSegment {
    /// Index of the segment.
    pub id: i64,
    /// Start of its window, in frames of the spectrogram (10 ms).
    pub seek: i64,
    /// Start within the audio, in seconds.
    #[serde(deserialize_with = "null_as_nan")]
    pub start: f32,
    /// End within the audio, in seconds.
    #[serde(deserialize_with = "null_as_nan")]
    pub end: f32,
    /// Recognised text.
    pub text: String,
    /// Tokens of the text.
    pub tokens: Vec<i64>,
    /// Sampling temperature.
    #[serde(deserialize_with = "null_as_nan")]
    pub temperature: f32,
    /// Mean log-probability of the tokens.
    #[serde(deserialize_with = "null_as_nan")]
    pub avg_logprob: f32,
    /// Length of the text divided by its compressed length; high for repetitions.
    #[serde(deserialize_with = "null_as_nan")]
    pub compression_ratio: f32,
    /// Probability that there is no speech.
    #[serde(deserialize_with = "null_as_nan")]
    pub no_speech_prob: f32,
}

/// A transcription with its segments. `{}` writes the text, `{:#}` a line per segment.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct WhisperTranscription {
    /// Header of the audio.
    #[serde(flatten)]
    pub header: Header,
    /// Recognised text.
    pub text: String,
    /// Segments in the order of time.
    #[serde(default)]
    pub segments: Vec<WhisperSegment>,
    /// Proposed motion for better audio.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub action: Option<Action>,
}

target!(BaseTranscription, |_| None);
target!(VoskTranscription, |_| None);
target!(WhisperTranscription, |_| None);

impl fmt::Display for BaseTranscription {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write_text(&self.text, f)
    }
}

impl fmt::Display for VoskTranscription {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write_text(&self.text, f)
    }
}

impl fmt::Display for WhisperTranscription {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if !f.alternate() || self.segments.is_empty() {
            return write_text(&self.text, f);
        }
        for WhisperSegment { start, end, text, .. } in &self.segments {
            writeln!(f, "{start:.2} s to {end:.2} s: {}", text.trim())?;
        }
        Ok(())
    }
}

fn write_text(text: &str, f: &mut fmt::Formatter<'_>) -> fmt::Result {
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
        let transcription =
            WhisperTranscription { text, segments: vec![segment], ..WhisperTranscription::default() };
        assert_eq!(transcription.to_string(), " hello robot");
        assert_eq!(format!("{transcription:#}"), "0.50 s to 1.25 s: hello robot\n");
    }
}
