//! From probabilities to speech that begins and ends.

use crate::voice_activity::{CHUNK, SAMPLE_RATE};

/// When speech begins and when it is over.
///
/// It begins with a chunk whose probability reaches `threshold`. It is over once the probability was below `threshold` less
/// [`VoiceRule::HYSTERESIS`] and has not reached `threshold` again for `min_silence` samples.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VoiceRule {
    /// The least probability that speech begins with, 0..=1.
    pub threshold: f32,
    /// How long it must be quiet until speech is over, in samples at 16 kHz.
    pub min_silence: u64,
    /// What is added to speech at both of its ends, in samples at 16 kHz.
    pub pad: u64,
}

/// Half, 100 ms and 30 ms, as Silero's iterator has it.
impl Default for VoiceRule {
    fn default() -> Self {
        Self::from_milliseconds(0.5, 100, 30)
    }
}

/// What is known of the speech in a stream.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Speech {
    active: bool,
    /// Samples of the chunks so far.
    heard: u64,
    /// Where the chunks that may be its end begin.
    quiet_from: Option<u64>,
}

/// Where speech begins or ends, in samples from the begin of the stream.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SpeechChange {
    /// The first sample of speech.
    Begin(u64),
    /// The sample after the last of speech.
    End(u64),
}

impl VoiceRule {
    /// How far below the threshold it is quiet.
    pub const HYSTERESIS: f32 = 0.15;

    /// A rule with its times in milliseconds.
    pub fn from_milliseconds(threshold: f32, min_silence: u32, pad: u32) -> Self {
        let samples = |milliseconds: u32| u64::from(milliseconds) * u64::from(SAMPLE_RATE) / 1000;
        Self { threshold, min_silence: samples(min_silence), pad: samples(pad) }
    }

    /// Takes the probability of the next chunk of [`CHUNK`] samples.
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
        // The time is counted from the end of the first quiet chunk, as Silero does.
        if begin - quiet_from < self.min_silence {
            return None;
        }
        (speech.active, speech.quiet_from) = (false, None);
        Some(SpeechChange::End(quiet_from + self.pad))
    }
}

impl Speech {
    /// Whether somebody speaks, by the chunks so far.
    pub fn is_active(&self) -> bool {
        self.active
    }

    /// Samples of the chunks so far.
    pub fn heard(&self) -> u64 {
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
    fn a_short_pause_is_speech() {
        let chunk = CHUNK as u64;
        assert_eq!(changes(&[0.1, 0.9, 0.1, 0.1, 0.9, 0.1, 0.1]), [SpeechChange::Begin(chunk - 480)]);
        let long = changes(&[0.9, 0.1, 0.1, 0.1, 0.1, 0.1, 0.9]);
        assert_eq!(
            long,
            [SpeechChange::Begin(0), SpeechChange::End(chunk + 480), SpeechChange::Begin(6 * chunk - 480)]
        );
    }

    #[test]
    fn what_is_neither_loud_nor_quiet_changes_nothing() {
        assert!(changes(&[0.49; 20]).is_empty());
        assert_eq!(changes(&[&[0.5][..], &[0.36; 20]].concat()), [SpeechChange::Begin(0)]);
    }

    #[test]
    fn no_number_is_no_speech() {
        assert!(changes(&[f32::NAN; 9]).is_empty());
        assert_eq!(changes(&[&[0.9][..], &[f32::NAN; 9]].concat()).len(), 2);
    }
}
