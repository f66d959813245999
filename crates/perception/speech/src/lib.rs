//! Keyword spotting, speech transcription and voice activity detection.
//!
//! [`speech_recognition`] classifies spoken words: [`MatchboxNet`](speech_recognition::MatchboxNet),
//! [`EdgeSpeechNets`](speech_recognition::EdgeSpeechNets), [`QuadraticSelfOnn`](speech_recognition::QuadraticSelfOnn) and
//! [`DsCnn`](speech_recognition::DsCnn). [`speech_transcription`] transcribes speech with
//! [`Whisper`](speech_transcription::Whisper). [`voice_activity_detection`] has the learner
//! [`SileroVad`](voice_activity_detection::SileroVad), and [`voice_activity`] its network and hysteresis without a learner. The
//! feature `training` adds `fit` to the keyword spotting learners that train. MFCC features and resampling are in the crate
//! `opendr-audio`.
//!
//! Begin with `MatchboxNet` for commands or `Whisper` for sentences.
//!
//! ```
//! use opendr_engine::data::Audio;
//! use opendr_speech::speech_recognition::AudioInput;
//!
//! // A second of silence as input of any learner of this crate.
//! let audio = Audio::new(vec![0.0; 16_000], 1, 16_000)?;
//! let samples = AudioInput::from(&audio).samples(16_000)?;
//! assert_eq!(samples.len(), 16_000);
//! # Ok::<(), opendr_engine::Error>(())
//! ```

pub mod speech_recognition;
pub mod speech_transcription;
pub mod voice_activity;
pub mod voice_activity_detection;
