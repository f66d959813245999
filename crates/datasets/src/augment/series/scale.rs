//! Random scale.

use opendr_engine::dataset::Sample;
use opendr_engine::params::Params;
use opendr_engine::{Random, Result};

use crate::augment::series::rows::for_each_series;
use crate::augment::{Augment, Augmentation, OtherSamples};

/// Multiplies each feature by a random factor, which is constant over time.
#[derive(Debug, Clone, Params)]
pub struct SeriesScale {
    /// Standard deviation of the factors around 1.
    #[param(default = 0.1, range = 0.0..=10.0)]
    pub deviation: f32,
}

impl Augmentation for SeriesScale {
    const NAME: &'static str = "series_scale";
    const ABOUT: &'static str = "scales the features of a time series";
}

impl Augment for SeriesScale {
    fn apply(&self, sample: &mut Sample, random: &mut Random, _: &OtherSamples<'_>) -> Result<()> {
        for_each_series(sample, |numbers, features| {
            let factors: Vec<f32> =
                (0..features).map(|_| 1.0 + random.normal() as f32 * self.deviation).collect();
            for instant in numbers.chunks_exact_mut(features) {
                instant.iter_mut().zip(&factors).for_each(|(number, factor)| *number *= factor);
            }
        })
    }
}
