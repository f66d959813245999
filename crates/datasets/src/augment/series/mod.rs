//! Augmentations of time series and spectrograms.

mod jitter;
mod rows;
mod scale;
mod spec_augment;

pub use jitter::SeriesJitter;
pub use scale::SeriesScale;
pub use spec_augment::SpecAugment;

#[cfg(test)]
mod tests;
