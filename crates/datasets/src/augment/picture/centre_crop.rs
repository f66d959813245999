//! Central crop.

use opendr_engine::dataset::Sample;
use opendr_engine::params::Params;
use opendr_engine::{Random, Result};

use crate::augment::picture::{AffineMap, Border, image_size, transform};
use crate::augment::{Augment, Augmentation, OtherSamples};

/// Crops the centre of an image; a smaller image is padded with grey on all sides.
#[derive(Debug, Clone, Params)]
pub struct CentreCrop {
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

impl Augmentation for CentreCrop {
    const NAME: &'static str = "centre_crop";
    const ABOUT: &'static str = "crops the centre";
}

impl Augment for CentreCrop {
    fn apply(&self, sample: &mut Sample, _: &mut Random, _: &OtherSamples<'_>) -> Result<()> {
        let (size, output_size) = (image_size(sample)?, [self.width, self.height]);
        let corner = [0, 1].map(|axis| (size[axis] as i64 - output_size[axis] as i64).div_euclid(2));
        transform(
            sample,
            &AffineMap::crop(size, corner, output_size),
            &Border::with_min_visible(self.min_visible),
        )
    }
}
