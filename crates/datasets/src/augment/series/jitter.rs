//! Measurement noise.

use opendr_engine::dataset::Sample;
use opendr_engine::params::Params;
use opendr_engine::{Random, Result};

use crate::augment::series::rows::for_each_series;
use crate::augment::{Augment, Augmentation, OtherSamples};

/// Adds noise to every value, in proportion to the standard deviation of its feature.
#[derive(Debug, Clone, Params)]
pub struct SeriesJitter {
    /// Standard deviation of the noise, relative to the feature's standard deviation over time.
    #[param(default = 0.03, range = 0.0..=10.0)]
    pub deviation: f32,
}

impl Augmentation for SeriesJitter {
    const NAME: &'static str = "series_jitter";
    const ABOUT: &'static str = "adds noise to a time series";
}

impl Augment for SeriesJitter {
    fn apply(&self, sample: &mut Sample, random: &mut Random, _: &OtherSamples<'_>) -> Result<()> {
        for_each_series(sample, |numbers, features| {
            for feature in 0..features {
                let noise =
                    f64::from(self.deviation) * deviation(numbers.iter().skip(feature).step_by(features));
                for number in numbers.iter_mut().skip(feature).step_by(features) {
                    *number += (random.normal() * noise) as f32;
                }
            }
        })
    }
}

fn deviation<'a>(numbers: impl ExactSizeIterator<Item = &'a f32> + Clone) -> f64 {
    let count = numbers.len().max(1) as f64;
    let mean = numbers.clone().map(|number| f64::from(*number)).sum::<f64>() / count;
    (numbers.map(|number| (f64::from(*number) - mean).powi(2)).sum::<f64>() / count).sqrt()
}
