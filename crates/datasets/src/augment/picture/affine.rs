//! Affine transformation.

use opendr_engine::dataset::Sample;
use opendr_engine::params::Params;
use opendr_engine::{Random, Result};

use crate::augment::picture::{AffineMap, Border, image_size, transform};
use crate::augment::{Augment, Augmentation, OtherSamples};

/// Rotates, scales, shears and shifts an image about its centre, with one resampling. The size is kept.
#[derive(Debug, Clone, Params)]
pub struct Affine {
    /// Largest angle in either direction.
    #[param(default = 0.0, range = 0.0..=3.15, unit = "rad")]
    pub max_angle: f32,
    /// Smallest factor.
    #[param(default = 0.5, range = 0.01..=16.0, log)]
    pub min_scale: f32,
    /// Largest factor.
    #[param(default = 1.5, range = 0.01..=16.0, log)]
    pub max_scale: f32,
    /// Largest shear along x and along y, in either direction; the tangent of the shear angle.
    #[param(default = 0.0, range = 0.0..=2.0)]
    pub max_shear: f32,
    /// Largest shift along x and along y in either direction, as a share of the side.
    #[param(default = 0.1, range = 0.0..=1.0)]
    pub max_shift: f32,
    /// Smallest share of a box inside the image; boxes with less are dropped.
    #[param(default = 0.1, range = 0.0..=1.0)]
    pub min_visible: f32,
}

impl Augmentation for Affine {
    const NAME: &'static str = "affine";
    const ABOUT: &'static str = "rotates, scales, shears and shifts";
}

impl Augment for Affine {
    fn apply(&self, sample: &mut Sample, random: &mut Random, _: &OtherSamples<'_>) -> Result<()> {
        let size = image_size(sample)?;
        let mut either_way = |most: f32| f64::from(random.uniform(-most, most));
        let (sine, cosine) = either_way(self.max_angle).sin_cos();
        let [across, down] = [either_way(self.max_shear), either_way(self.max_shear)];
        let shift = size.map(|side| side as f64 * either_way(self.max_shift));
        let scale = f64::from(random.uniform(self.min_scale, self.max_scale));
        // The rotation, then the shear [[1, across], [down, 1]].
        let linear =
            [[cosine - across * sine, sine + across * cosine], [down * cosine - sine, down * sine + cosine]];
        let map = AffineMap::about_centre(size, linear.map(|row| row.map(|part| part * scale)), shift);
        transform(sample, &map, &Border::with_min_visible(self.min_visible))
    }
}
