//! Noise of a lidar.

use opendr_engine::dataset::Sample;
use opendr_engine::params::Params;
use opendr_engine::{Random, Result};

use crate::augment::cloud::points::for_each_cloud;
use crate::augment::{Augment, Augmentation, OtherSamples};

/// Adds Gaussian noise to the coordinates of every point; its other values are kept.
#[derive(Debug, Clone, Params)]
pub struct JitterPoints {
    /// Standard deviation along each axis.
    #[param(default = 0.01, range = 0.0..=10.0, unit = "m")]
    pub deviation: f32,
    /// Largest displacement along each axis.
    #[param(default = 0.05, range = 0.0..=10.0, unit = "m", former = "most")]
    pub max_offset: f32,
}

impl Augmentation for JitterPoints {
    const NAME: &'static str = "jitter_points";
    const ABOUT: &'static str = "adds noise to the points of a cloud";
}

impl Augment for JitterPoints {
    fn apply(&self, sample: &mut Sample, random: &mut Random, _: &OtherSamples<'_>) -> Result<()> {
        for_each_cloud(sample, |data, channels| {
            for point in data.chunks_exact_mut(channels) {
                for part in &mut point[..3] {
                    let noise = random.normal() as f32 * self.deviation;
                    *part += noise.clamp(-self.max_offset, self.max_offset);
                }
            }
        })
    }
}
