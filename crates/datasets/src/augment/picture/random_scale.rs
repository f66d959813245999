//! Random size with the aspect ratio kept.

use opendr_engine::dataset::Sample;
use opendr_engine::params::Params;
use opendr_engine::{Random, Result};

use crate::augment::picture::{AffineMap, Border, image_size, transform};
use crate::augment::{Augment, Augmentation, OtherSamples};

/// Scales an image by a random factor; a crop usually follows.
#[derive(Debug, Clone, Params)]
pub struct RandomScale {
    /// Smallest factor.
    #[param(default = 0.5, range = 0.01..=16.0, log)]
    pub min_scale: f32,
    /// Largest factor.
    #[param(default = 2.0, range = 0.01..=16.0, log)]
    pub max_scale: f32,
}

impl Augmentation for RandomScale {
    const NAME: &'static str = "random_scale";
    const ABOUT: &'static str = "scales by a random factor";
}

impl Augment for RandomScale {
    fn apply(&self, sample: &mut Sample, random: &mut Random, _: &OtherSamples<'_>) -> Result<()> {
        let (size, scale) = (image_size(sample)?, random.uniform(self.min_scale, self.max_scale));
        let output_size = size.map(|side| (side as f32 * scale).round().max(1.0) as usize);
        transform(sample, &AffineMap::stretch(size, output_size), &Border::default())
    }
}
