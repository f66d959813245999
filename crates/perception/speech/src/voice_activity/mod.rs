//! Voice activity detection: a speech probability for every 32 ms of audio, and the start and end of speech.
//!
//! [`VoiceNetwork`] is Silero's network (Silero Team, Silero VAD, 2024). [`VoiceRule`] turns its probabilities into speech with
//! a start and an end, with the hysteresis of that project's iterator. Both process a stream in pieces of any length; the state
//! is in [`VoiceStream`] and [`Speech`]. Time is counted in samples.
//!
//! ```
//! use opendr_speech::voice_activity::{CHUNK, Speech, SpeechChange, VoiceRule};
//!
//! let rule = VoiceRule::default();
//! let mut speech = Speech::default();
//! let probabilities = [0.1, 0.9, 0.9, 0.4, 0.1, 0.1, 0.1, 0.1, 0.1];
//! let changes: Vec<_> = probabilities.iter().filter_map(|probability| rule.next(&mut speech, *probability)).collect();
//! let chunk = CHUNK as u64;
//! assert_eq!(changes, [SpeechChange::Begin(chunk - 480), SpeechChange::End(4 * chunk + 480)]);
//! ```

mod network;
mod rule;

pub use network::{CHUNK, SAMPLE_RATE, VoiceNetwork, VoiceStream};
pub use rule::{Speech, SpeechChange, VoiceRule};
