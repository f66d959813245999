//! A part of a picture.

use opendr_engine::dataset::Sample;
use opendr_engine::params::Params;
use opendr_engine::{Random, Result};

use crate::augment::picture::{Border, PictureMap, picture_size, transform};
use crate::augment::{Augment, Augmentation, Others};

/// Cuts a window of fixed size out of a picture, anywhere; a smaller picture is put anywhere on grey.
#[derive(Debug, Clone, Params)]
pub struct RandomCrop {
    /// Width of the result.
    #[param(default = 416, range = 1..=65535, unit = "px")]
    pub width: usize,
    /// Height of the result.
    #[param(default = 416, range = 1..=65535, unit = "px")]
    pub height: usize,
    /// Boxes with less than this share of their area inside are dropped.
    #[param(default = 0.1, range = 0.0..=1.0)]
    pub min_visible: f32,
}

impl Augmentation for RandomCrop {
    const NAME: &'static str = "random_crop";
    const ABOUT: &'static str = "cuts out a window of fixed size";
}

impl Augment for RandomCrop {
    fn apply(&self, sample: &mut Sample, random: &mut Random, _: &Others<'_>) -> Result<()> {
        let (size, wanted) = (picture_size(sample)?, [self.width, self.height]);
        let corner = [0, 1].map(|axis| {
            let place = random.below(size[axis].abs_diff(wanted[axis]) + 1) as i64;
            if size[axis] < wanted[axis] { -place } else { place }
        });
        transform(sample, &PictureMap::crop(size, corner, wanted), &Border::keeping(self.min_visible))
    }
}
