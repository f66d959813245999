//! Random crop, resized (Szegedy et al., Going deeper with convolutions, 2015).

use opendr_engine::dataset::Sample;
use opendr_engine::params::Params;
use opendr_engine::{Random, Result};

use crate::augment::picture::{AffineMap, Border, image_size, transform};
use crate::augment::{Augment, Augmentation, OtherSamples};

/// Number of windows that are drawn before the central one is used.
const TRIES: usize = 10;

/// Crops a window of random area and aspect ratio and resizes it to a fixed size.
#[derive(Debug, Clone, Params)]
pub struct RandomResizedCrop {
    /// Width of the result.
    #[param(default = 416, range = 1..=65535, unit = "px")]
    pub width: usize,
    /// Height of the result.
    #[param(default = 416, range = 1..=65535, unit = "px")]
    pub height: usize,
    /// Smallest area of the window, as a share of the image's.
    #[param(default = 0.08, range = 0.0001..=1.0)]
    pub min_area: f32,
    /// Largest area of the window, as a share of the image's.
    #[param(default = 1.0, range = 0.0001..=1.0)]
    pub max_area: f32,
    /// Smallest aspect ratio (width over height) of the window.
    #[param(default = 0.75, range = 0.01..=100.0, log)]
    pub min_ratio: f32,
    /// Largest aspect ratio of the window.
    #[param(default = 1.333, range = 0.01..=100.0, log)]
    pub max_ratio: f32,
    /// Smallest share of a box inside the window; boxes with less are dropped.
    #[param(default = 0.1, range = 0.0..=1.0)]
    pub min_visible: f32,
}

impl RandomResizedCrop {
    /// Draws the window `[left, top, width, height]`; the largest central one if no drawn window fits.
    fn window(&self, size: [usize; 2], random: &mut Random) -> [usize; 4] {
        let [width, height] = size.map(|side| side as f32);
        for _ in 0..TRIES {
            let area = width * height * random.uniform(self.min_area, self.max_area);
            // A uniform logarithm would treat r and 1/r alike. Drawing the inverse half of the time does so, too,
            // and rounds the same on every platform.
            let ratio = match random.chance(0.5) {
                true => random.uniform(self.min_ratio, self.max_ratio),
                false => 1.0 / random.uniform(1.0 / self.max_ratio, 1.0 / self.min_ratio),
            };
            let sides =
                [(area * ratio).sqrt(), (area / ratio).sqrt()].map(|side| side.round().max(1.0) as usize);
            if sides[0] <= size[0] && sides[1] <= size[1] {
                let corner = [0, 1].map(|axis| random.below(size[axis] - sides[axis] + 1));
                return [corner[0], corner[1], sides[0], sides[1]];
            }
        }
        let ratio = (width / height).max(self.min_ratio).min(self.max_ratio);
        let sides = [width.min(height * ratio), height.min(width / ratio)];
        let sides = [0, 1].map(|axis| (sides[axis].round() as usize).clamp(1, size[axis]));
        [(size[0] - sides[0]) / 2, (size[1] - sides[1]) / 2, sides[0], sides[1]]
    }
}

impl Augmentation for RandomResizedCrop {
    const NAME: &'static str = "random_resized_crop";
    const ABOUT: &'static str = "crops a window of random area and aspect ratio, and resizes it";
}

impl Augment for RandomResizedCrop {
    fn apply(&self, sample: &mut Sample, random: &mut Random, _: &OtherSamples<'_>) -> Result<()> {
        let (size, output_size) = (image_size(sample)?, [self.width, self.height]);
        let window = self.window(size, random);
        let map = AffineMap::window(size, window, [0, 0, self.width, self.height], output_size);
        transform(sample, &map, &Border::with_min_visible(self.min_visible))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn windows_fit_and_have_the_requested_aspect_ratio() {
        let crop = RandomResizedCrop { min_area: 0.25, max_area: 0.5, ..Default::default() };
        let mut random = Random::new(0);
        for size in [[640, 480], [100, 90], [480, 640]] {
            for _ in 0..300 {
                let [left, top, width, height] = crop.window(size, &mut random);
                assert!(left + width <= size[0] && top + height <= size[1]);
                let share = (width * height) as f32 / (size[0] * size[1]) as f32;
                let ratio = width as f32 / height as f32;
                assert!((0.23..0.52).contains(&share) && (0.73..1.37).contains(&ratio), "{share} {ratio}");
            }
        }
        // No window of that aspect ratio fits into a strip, so the largest central one is used.
        assert_eq!(crop.window([1000, 1], &mut random), [499, 0, 1, 1]);
    }
}
