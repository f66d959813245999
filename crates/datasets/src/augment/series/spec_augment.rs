//! SpecAugment (Park et al., SpecAugment, 2019).

use opendr_engine::dataset::Sample;
use opendr_engine::params::Params;
use opendr_engine::{Random, Result};

use crate::augment::series::rows::for_each_series;
use crate::augment::{Augment, Augmentation, OtherSamples};

/// Masks random spans of time and bands of frequency of a spectrogram, a
/// [`Timeseries`](opendr_engine::data::Timeseries) `[time, bands]`.
#[derive(Debug, Clone, Params)]
pub struct SpecAugment {
    /// Number of time masks.
    #[param(default = 2, range = 0..=100)]
    pub time_masks: usize,
    /// Longest time mask, in time steps.
    #[param(default = 40, range = 0..=100_000)]
    pub max_time: usize,
    /// Longest time mask, as a share of the length.
    #[param(default = 0.2, range = 0.0..=1.0)]
    pub max_time_share: f32,
    /// Number of frequency masks.
    #[param(default = 2, range = 0..=100)]
    pub frequency_masks: usize,
    /// Widest frequency mask, in bands of the spectrogram.
    #[param(default = 15, range = 0..=100_000)]
    pub max_frequency: usize,
    /// Value of masked cells; 0 is the mean of normalised spectrograms.
    #[param(default = 0.0)]
    pub level: f32,
}

impl Augmentation for SpecAugment {
    const NAME: &'static str = "spec_augment";
    const ABOUT: &'static str = "masks spans of time and bands of frequency of a spectrogram";
}

impl Augment for SpecAugment {
    fn apply(&self, sample: &mut Sample, random: &mut Random, _: &OtherSamples<'_>) -> Result<()> {
        for_each_series(sample, |numbers, bands| {
            let instants = numbers.len() / bands;
            let longest = self.max_time.min((instants as f32 * self.max_time_share) as usize);
            for _ in 0..self.time_masks {
                let [start, end] = span(instants, longest, random);
                numbers[start * bands..end * bands].fill(self.level);
            }
            for _ in 0..self.frequency_masks {
                let [start, end] = span(bands, self.max_frequency, random);
                numbers.chunks_exact_mut(bands).for_each(|instant| instant[start..end].fill(self.level));
            }
        })
    }
}

/// Draws a span of at most `longest` of `count` places.
fn span(count: usize, longest: usize, random: &mut Random) -> [usize; 2] {
    let length = random.below(longest.min(count) + 1);
    let start = random.below(count - length + 1);
    [start, start + length]
}
