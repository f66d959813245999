//! Speech: words, sentences, and whether anyone speaks.
//!
//! Begin with [`speech_recognition::MatchboxNet`] for commands or [`speech_transcription::Whisper`] for sentences.

pub mod speech_recognition;
pub mod speech_transcription;
pub mod voice_activity;
pub mod voice_activity_detection;
