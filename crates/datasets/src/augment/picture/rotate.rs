//! Rotation.

use opendr_engine::dataset::Sample;
use opendr_engine::params::Params;
use opendr_engine::{Random, Result};

use crate::augment::picture::{AffineMap, Border, image_size, transform};
use crate::augment::{Augment, Augmentation, OtherSamples};

/// Rotates an image about its centre. The size is kept.
#[derive(Debug, Clone, Params)]
pub struct Rotate {
    /// Largest angle in either direction.
    #[param(default = 0.17, range = 0.0..=3.15, unit = "rad")]
    pub max_angle: f32,
    /// Smallest share of a box inside the image; boxes with less are dropped.
    #[param(default = 0.1, range = 0.0..=1.0)]
    pub min_visible: f32,
}

impl Augmentation for Rotate {
    const NAME: &'static str = "rotate";
    const ABOUT: &'static str = "rotates about the centre";
}

impl Augment for Rotate {
    fn apply(&self, sample: &mut Sample, random: &mut Random, _: &OtherSamples<'_>) -> Result<()> {
        let angle = f64::from(random.uniform(-self.max_angle, self.max_angle));
        let (sine, cosine) = angle.sin_cos();
        let map = AffineMap::about_centre(image_size(sample)?, [[cosine, sine], [-sine, cosine]], [0.0; 2]);
        transform(sample, &map, &Border::with_min_visible(self.min_visible))
    }
}
