//! Letterbox.

use opendr_engine::dataset::Sample;
use opendr_engine::params::Params;
use opendr_engine::{Random, Result};

use crate::augment::picture::{AffineMap, Border, image_size, transform};
use crate::augment::{Augment, Augmentation, OtherSamples};

/// Resizes an image to a fixed size, keeps its aspect ratio and pads the rest equally on both sides.
#[derive(Debug, Clone, Params)]
pub struct Letterbox {
    /// Width of the result.
    #[param(default = 416, range = 1..=65535, unit = "px")]
    pub width: usize,
    /// Height of the result.
    #[param(default = 416, range = 1..=65535, unit = "px")]
    pub height: usize,
    /// Level of the padding.
    #[param(default = 114, range = 0..=255)]
    pub level: u32,
}

impl Augmentation for Letterbox {
    const NAME: &'static str = "letterbox";
    const ABOUT: &'static str = "resizes to a fixed size with the aspect ratio kept, and pads";
}

impl Augment for Letterbox {
    fn apply(&self, sample: &mut Sample, _: &mut Random, _: &OtherSamples<'_>) -> Result<()> {
        let (size, output_size) = (image_size(sample)?, [self.width, self.height]);
        let scale =
            (0..2).map(|axis| output_size[axis] as f64 / size[axis] as f64).fold(f64::INFINITY, f64::min);
        let sides =
            [0, 1].map(|axis| ((size[axis] as f64 * scale).round() as usize).min(output_size[axis]).max(1));
        let corner = [0, 1].map(|axis| output_size[axis].saturating_sub(sides[axis]) / 2);
        let rectangle = [corner[0], corner[1], sides[0], sides[1]];
        let map = AffineMap::window(size, [0, 0, size[0], size[1]], rectangle, output_size);
        transform(sample, &map, &Border { level: self.level.min(255) as u8, ..Border::default() })
    }
}
