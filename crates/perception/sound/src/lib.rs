//! Sound for learners that hear: [`mfcc`] makes cepstra, [`resampler`] changes the sample rate, [`Sound`] is the input.
//!
//! Begin with [`mfcc::Mfcc`].

pub mod mfcc;
pub mod resampler;

mod sound;
mod standardise;

pub use sound::Sound;
pub use standardise::standardise;
