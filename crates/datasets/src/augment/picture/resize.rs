//! Resizing.

use opendr_engine::dataset::Sample;
use opendr_engine::params::Params;
use opendr_engine::{Random, Result};

use crate::augment::picture::{AffineMap, Border, image_size, transform};
use crate::augment::{Augment, Augmentation, OtherSamples};

/// Resizes an image to a fixed size without keeping its aspect ratio.
#[derive(Debug, Clone, Params)]
pub struct Resize {
    /// Width of the result.
    #[param(default = 416, range = 1..=65535, unit = "px")]
    pub width: usize,
    /// Height of the result.
    #[param(default = 416, range = 1..=65535, unit = "px")]
    pub height: usize,
}

impl Augmentation for Resize {
    const NAME: &'static str = "resize";
    const ABOUT: &'static str = "resizes to a fixed size";
}

impl Augment for Resize {
    fn apply(&self, sample: &mut Sample, _: &mut Random, _: &OtherSamples<'_>) -> Result<()> {
        let map = AffineMap::stretch(image_size(sample)?, [self.width, self.height]);
        transform(sample, &map, &Border::default())
    }
}
