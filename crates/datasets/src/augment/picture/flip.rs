//! Mirroring.

use opendr_engine::dataset::Sample;
use opendr_engine::params::Params;
use opendr_engine::{Random, Result};

use crate::augment::picture::{AffineMap, Border, image_size, transform};
use crate::augment::{Augment, Augmentation, OtherSamples};

opendr_engine::choices! {
    /// Direction of mirroring.
    pub enum FlipDirection {
        /// Swaps left and right.
        Horizontal = "horizontal",
        /// Swaps top and bottom.
        Vertical = "vertical",
    }
}

/// Mirrors an image. Left and right keypoints are swapped: a left hand becomes a right one.
#[derive(Debug, Clone, Params)]
pub struct Flip {
    /// Direction of mirroring.
    pub direction: FlipDirection,
}

impl Augmentation for Flip {
    const NAME: &'static str = "flip";
    const ABOUT: &'static str = "mirrors an image; left and right keypoints are swapped";
}

impl Augment for Flip {
    fn apply(&self, sample: &mut Sample, _: &mut Random, _: &OtherSamples<'_>) -> Result<()> {
        let size = image_size(sample)?;
        let map = match self.direction {
            FlipDirection::Horizontal => AffineMap::flip_horizontal(size),
            FlipDirection::Vertical => AffineMap::flip_vertical(size),
        };
        transform(sample, &map, &Border::default())
    }
}
