//! Depth in metres from disparities.

use opendr_engine::data::{Image, PointCloud};
use opendr_engine::{Error, Result};

/// A rectified stereo camera. Its coordinate frame is the left camera's: x right, y down, z forward.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StereoCamera {
    /// Focal length, in pixels.
    pub focal_length: f32,
    /// Distance between the two cameras, in metres.
    pub baseline: f32,
    /// Principal point of the left camera, in pixels.
    pub principal_point: [f32; 2],
    /// Offset of the right camera's principal point to the right, in pixels; added to disparities (Middlebury's
    /// `doffs`).
    pub principal_point_offset: f32,
}

impl StereoCamera {
    /// Returns the depth of a pixel in metres; 0 where the disparity is 0 (unknown) or the depth would be negative.
    pub fn depth(&self, disparity: f32) -> f32 {
        let shift = disparity + self.principal_point_offset;
        let is_known = disparity > 0.0 && shift > 0.0;
        if is_known { self.focal_length * self.baseline / shift } else { 0.0 }
    }

    /// Returns the 3D position of the pixel with its centre at `[x, y]`, `depth` metres in front of the camera.
    pub fn point(&self, [x, y]: [f32; 2], depth: f32) -> [f32; 3] {
        let [right, down] = [x - self.principal_point[0], y - self.principal_point[1]]
            .map(|off| off * depth / self.focal_length);
        [right, down, depth]
    }

    /// Returns a point for each pixel of a depth map `[height, width]` in metres with a known depth below `farthest`:
    /// x, y, z, and with an image of the same size also red, green and blue, 0..=255.
    ///
    /// # Errors
    /// `InvalidInput` when the image or the map does not have the size `size`, `[width, height]`.
    pub fn points(
        &self,
        depths: &[f32],
        size @ [width, height]: [usize; 2],
        farthest: f32,
        colours: Option<&Image>,
    ) -> Result<PointCloud> {
        let is_wrong = |image: &&Image| [image.width(), image.height()] != size;
        if width.checked_mul(height) != Some(depths.len()) || colours.as_ref().is_some_and(is_wrong) {
            return Err(Error::invalid_input(format!(
                "a depth map of {} values and its image do not match the size {width}x{height}; pass depth and image of one frame",
                depths.len()
            )));
        }
        let channels = if colours.is_some() { 6 } else { 3 };
        let mut numbers = Vec::new();
        for (at, depth) in depths.iter().enumerate().filter(|(_, depth)| **depth > 0.0 && **depth < farthest)
        {
            let (x, y) = (at % width, at / width);
            numbers.extend(self.point([x as f32 + 0.5, y as f32 + 0.5], *depth));
            if let Some(image) = colours {
                let offsets = image.format().rgb_offsets();
                numbers.extend(offsets.map(|channel| f32::from(image.view().sample_u8(x, y, channel))));
            }
        }
        let count = numbers.len() / channels;
        PointCloud::new(numbers, [count, channels])
    }
}
