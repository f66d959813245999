//! A pinhole camera.

use opendr_engine::{Error, Result};

use super::vector::Vector;

/// A camera without distortion; the centre of the first pixel is at 0. With a `baseline` it is the left one of a rectified pair of
/// equal cameras, or a depth camera, whose depths are treated as disparities of such a pair.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PinholeCamera {
    /// Width and height of the images, in pixels.
    pub size: [usize; 2],
    /// Focal lengths in x and y, in pixels.
    pub focal_length: [f64; 2],
    /// Principal point, in pixels.
    pub principal_point: [f64; 2],
    /// Distance between the cameras of the pair, in metres; for a depth camera the baseline of its emitter, from which the accuracy of
    /// its depths follows. Unused for a single camera.
    pub baseline: f64,
}

/// Returns whether images of this size can be tracked: of 64x64 to 2^24 pixels.
pub(crate) fn is_image_size([width, height]: [usize; 2]) -> bool {
    width >= 64 && height >= 64 && width.saturating_mul(height) <= 1 << 24
}

impl PinholeCamera {
    /// Checks the numbers.
    ///
    /// # Errors
    /// `InvalidParam` for images smaller than 64x64 or larger than 2^24 pixels, and for numbers that are not positive and finite.
    pub fn check(&self) -> Result<()> {
        let is_positive = |value: f64| value > 0.0 && value < 1e6;
        let centre = self.principal_point;
        if !is_image_size(self.size)
            || !self.focal_length.into_iter().all(is_positive)
            || !centre.iter().all(|part| part.abs() < 1e6)
            || !is_positive(self.baseline)
        {
            return Err(Error::invalid_param(format!(
                "the camera is {self:?}; give images of 64x64 to 2^24 pixels, focal lengths in pixels and a baseline in metres above 0, and the principal point in pixels"
            )));
        }
        Ok(())
    }

    /// Returns the pixel of a point in the camera's frame; `None` for a point that is less than a millimetre ahead.
    pub fn project(&self, [x, y, z]: [f64; 3]) -> Option<[f64; 2]> {
        let ([fx, fy], [cx, cy]) = (self.focal_length, self.principal_point);
        (z > 1e-3).then(|| [fx * x / z + cx, fy * y / z + cy])
    }

    /// Returns the point of a pixel at `depth` metres along the optical axis.
    pub fn point(&self, pixel: [f64; 2], depth: f64) -> [f64; 3] {
        let [x, y, _] = self.ray(pixel);
        [x * depth, y * depth, depth]
    }

    /// Returns the direction of a pixel with z = 1.
    pub fn ray(&self, [u, v]: [f64; 2]) -> Vector {
        let ([fx, fy], [cx, cy]) = (self.focal_length, self.principal_point);
        [(u - cx) / fx, (v - cy) / fy, 1.0]
    }

    /// Returns the disparity of a depth, in pixels.
    pub fn disparity(&self, depth: f64) -> f64 {
        self.focal_length[0] * self.baseline / depth
    }

    /// Returns whether a pixel is at least `margin` pixels within the image.
    pub fn contains(&self, pixel: [f64; 2], margin: f64) -> bool {
        let [width, height] = self.size.map(|side| side as f64);
        let inside = |at: f64, side: f64| at >= margin && at <= side - 1.0 - margin;
        inside(pixel[0], width) && inside(pixel[1], height)
    }
}
