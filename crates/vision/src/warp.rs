//! Affine crops of images.

use opendr_engine::{Error, Result};

/// An affine map from a crop to the image that it is taken from, for [`crate::Preprocess::warp_into`].
///
/// Positions are continuous, as in [`crate::InputGeometry`]: the left-top corner of the first pixel is (0, 0), its centre
/// (0.5, 0.5).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Warp {
    /// Image position of the crop's (0, 0).
    pub(crate) origin: [f64; 2],
    /// Image pixels from a column of the crop to the next.
    pub(crate) right: [f64; 2],
    /// Image pixels from a row of the crop to the next.
    pub(crate) down: [f64; 2],
}

impl Warp {
    /// Creates an upright crop whose left-top corner is at `origin` and whose pixels are `scale` image pixels wide and high.
    pub const fn upright(origin: [f64; 2], [across, down]: [f64; 2]) -> Self {
        Self { origin, right: [across, 0.0], down: [0.0, down] }
    }

    /// Maps a point of the crop to pixels of the image; the result may be outside the image.
    pub fn image_from_crop(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        [0, 1].map(|axis| x * self.right[axis] + y * self.down[axis] + self.origin[axis])
    }

    /// Returns the image position of the centre of the first pixel, and the steps to the next column and the next
    /// row, in image pixels times 2^32: [x, y] each. Positions are relative to the centre of the image's first pixel.
    ///
    /// # Errors
    /// `InvalidInput` when a pixel of a crop of `size` lies more than 2^29 pixels away or is not finite.
    pub(crate) fn fixed_point(&self, size: [usize; 2]) -> Result<[[i64; 2]; 3]> {
        const ONE: f64 = 4_294_967_296.0;
        const FURTHEST: f64 = 536_870_912.0;
        let [width, height] = size.map(|side| side as f64);
        let near = [[0.0, 0.0], [width, 0.0], [0.0, height], [width, height]]
            .into_iter()
            .all(|corner| self.image_from_crop(corner).iter().all(|value| value.abs() <= FURTHEST));
        let area = self.right[0] * self.down[1] - self.right[1] * self.down[0];
        if !area.is_normal() || !near {
            return Err(Error::invalid_input(format!(
                "a crop from {:?} by {:?} a column and {:?} a row has values that are not finite, an area of 0, or lies too far \
                 outside the image",
                self.origin, self.right, self.down
            )));
        }
        let fixed = |value: f64| (value * ONE).round() as i64;
        let first = self.image_from_crop([0.5; 2]).map(|value| fixed(value - 0.5));
        Ok([first, self.right.map(fixed), self.down.map(fixed)])
    }
}
