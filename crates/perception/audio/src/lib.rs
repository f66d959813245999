//! Audio features: MFCC, resampling, and audio as an input of learners.
//!
//! [`mfcc`] computes mel-frequency cepstral coefficients, of a whole recording or a stream; [`resampler`] changes the sample
//! rate; [`AudioInput`] is the input type of the learners of audio. Learners are in `opendr-speech` and `opendr-multimodal`, reading
//! and writing of WAVE files is in `opendr-datasets`.
//!
//! Begin with [`mfcc::Mfcc`].
//!
//! ```
//! use opendr_audio::resampler::resampled;
//!
//! let second = vec![0.1; 44_100];
//! assert_eq!(resampled(&second, 44_100, 16_000)?.len(), 16_000);
//! # Ok::<(), opendr_engine::Error>(())
//! ```

pub mod mfcc;
pub mod resampler;

mod audio_input;
mod standardise;

pub use audio_input::AudioInput;
pub use standardise::standardise;
