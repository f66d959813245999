//! Start and end of speech from probabilities.

use crate::voice_activity::{CHUNK, SAMPLE_RATE};

/// Hysteresis rule for the start and end of speech.
///
/// Speech starts with a chunk whose probability reaches `threshold`. It ends once the probability was below `threshold` less
/// [`VoiceRule::HYSTERESIS`] and has not reached `threshold` again for `min_silence` samples.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VoiceRule {
    /// Minimum probability at which speech starts, 0..=1.
    pub threshold: f32,
    /// Duration of silence that ends speech, in samples at 16 kHz.
    pub min_silence: u64,
    /// Padding at both ends of speech, in samples at 16 kHz.
    pub pad: u64,
}

/// 0.5, 100 ms and 30 ms, the defaults of Silero's iterator.
impl Default for VoiceRule {
    fn default() -> Self {
        Self::from_milliseconds(0.5, 100, 30)
    }
}

/// State of a [`VoiceRule`] in a stream.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Speech {
    active: bool,
    /// Number of samples of the chunks so far.
    heard: u64,
    /// Start of the silence that may end the speech.
    quiet_from: Option<u64>,
}

/// Start or end of speech, in samples from the start of the stream.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SpeechChange {
    /// The first sample of speech.
    Begin(u64),
    /// The sample after the last of speech.
    End(u64),
}

impl VoiceRule {
    /// Difference between the thresholds of start and end.
    pub const HYSTERESIS: f32 = 0.15;

    /// Creates a rule with durations in milliseconds.
    pub fn from_milliseconds(threshold: f32, min_silence: u32, pad: u32) -> Self {
        let samples = |milliseconds: u32| u64::from(milliseconds) * u64::from(SAMPLE_RATE) / 1000;
        Self { threshold, min_silence: samples(min_silence), pad: samples(pad) }
    }

    /// Processes the probability of the next chunk of [`CHUNK`] samples.
    pub fn next(&self, speech: &mut Speech, probability: f32) -> Option<SpeechChange> {
        let begin = speech.heard;
        speech.heard += CHUNK as u64;
        if probability >= self.threshold {
            speech.quiet_from = None;
            if speech.active {
                return None;
            }
            speech.active = true;
            return Some(SpeechChange::Begin(begin.saturating_sub(self.pad)));
        }
        if !speech.active || probability >= self.threshold - Self::HYSTERESIS {
            return None;
        }
        let quiet_from = *speech.quiet_from.get_or_insert(begin);
        // The time is counted from the end of the first quiet chunk, as in Silero's iterator.
        if begin - quiet_from < self.min_silence {
            return None;
        }
        (speech.active, speech.quiet_from) = (false, None);
        Some(SpeechChange::End(quiet_from + self.pad))
    }
}

impl Speech {
    /// Returns whether the last chunk is speech.
    pub fn is_active(&self) -> bool {
        self.active
    }

    /// Returns the number of samples of the chunks so far.
    pub fn samples(&self) -> u64 {
        self.heard
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn changes(probabilities: &[f32]) -> Vec<SpeechChange> {
        let mut speech = Speech::default();
        let rule = VoiceRule::default();
        probabilities.iter().filter_map(|probability| rule.next(&mut speech, *probability)).collect()
    }

    #[test]
    fn a_short_pause_does_not_end_speech() {
        let chunk = CHUNK as u64;
        assert_eq!(changes(&[0.1, 0.9, 0.1, 0.1, 0.9, 0.1, 0.1]), [SpeechChange::Begin(chunk - 480)]);
        let long = changes(&[0.9, 0.1, 0.1, 0.1, 0.1, 0.1, 0.9]);
        assert_eq!(
            long,
            [SpeechChange::Begin(0), SpeechChange::End(chunk + 480), SpeechChange::Begin(6 * chunk - 480)]
        );
    }

    #[test]
    fn probabilities_between_the_thresholds_change_nothing() {
        assert!(changes(&[0.49; 20]).is_empty());
        assert_eq!(changes(&[&[0.5][..], &[0.36; 20]].concat()), [SpeechChange::Begin(0)]);
    }

    #[test]
    fn nan_is_no_speech() {
        assert!(changes(&[f32::NAN; 9]).is_empty());
        assert_eq!(changes(&[&[0.9][..], &[f32::NAN; 9]].concat()).len(), 2);
    }
}
