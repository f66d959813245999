//! Mirror images.

use opendr_engine::dataset::Sample;
use opendr_engine::params::Params;
use opendr_engine::{Random, Result};

use crate::augment::picture::{Border, PictureMap, picture_size, transform};
use crate::augment::{Augment, Augmentation, Others};

opendr_engine::choices! {
    /// What changes places.
    pub enum FlipDirection {
        /// Left and right.
        Horizontal = "horizontal",
        /// Top and bottom.
        Vertical = "vertical",
    }
}

/// Turns a picture into its mirror image; what was a left hand is a right one then.
#[derive(Debug, Clone, Params)]
pub struct Flip {
    /// What changes places.
    pub direction: FlipDirection,
}

impl Augmentation for Flip {
    const NAME: &'static str = "flip";
    const ABOUT: &'static str = "mirrors a picture; left and right joints change their names";
}

impl Augment for Flip {
    fn apply(&self, sample: &mut Sample, _: &mut Random, _: &Others<'_>) -> Result<()> {
        let size = picture_size(sample)?;
        let map = match self.direction {
            FlipDirection::Horizontal => PictureMap::flip_horizontal(size),
            FlipDirection::Vertical => PictureMap::flip_vertical(size),
        };
        transform(sample, &map, &Border::default())
    }
}
