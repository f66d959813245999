//! Random crop.

use opendr_engine::dataset::Sample;
use opendr_engine::params::Params;
use opendr_engine::{Random, Result};

use crate::augment::picture::{AffineMap, Border, image_size, transform};
use crate::augment::{Augment, Augmentation, OtherSamples};

/// Crops a window of fixed size at a random place; a smaller image is placed at random on grey.
#[derive(Debug, Clone, Params)]
pub struct RandomCrop {
    /// Width of the result.
    #[param(default = 416, range = 1..=65535, unit = "px")]
    pub width: usize,
    /// Height of the result.
    #[param(default = 416, range = 1..=65535, unit = "px")]
    pub height: usize,
    /// Smallest share of a box inside the crop; boxes with less are dropped.
    #[param(default = 0.1, range = 0.0..=1.0)]
    pub min_visible: f32,
}

impl Augmentation for RandomCrop {
    const NAME: &'static str = "random_crop";
    const ABOUT: &'static str = "crops a window of fixed size";
}

impl Augment for RandomCrop {
    fn apply(&self, sample: &mut Sample, random: &mut Random, _: &OtherSamples<'_>) -> Result<()> {
        let (size, output_size) = (image_size(sample)?, [self.width, self.height]);
        let corner = [0, 1].map(|axis| {
            let place = random.below(size[axis].abs_diff(output_size[axis]) + 1) as i64;
            if size[axis] < output_size[axis] { -place } else { place }
        });
        transform(
            sample,
            &AffineMap::crop(size, corner, output_size),
            &Border::with_min_visible(self.min_visible),
        )
    }
}
