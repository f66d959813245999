//! Augmentations of audio.

mod gain;
mod noise;
mod shift;
mod sound;

pub use gain::AudioGain;
pub use noise::AudioNoise;
pub use shift::AudioShift;

#[cfg(test)]
mod tests;
