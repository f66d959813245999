//! From disparities to metres.

use opendr_engine::data::{Image, PointCloud};
use opendr_engine::{Error, Result};

/// A rectified stereo camera. Its frame is the left camera's: x right, y down, z ahead.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StereoCamera {
    /// Focal length, pixels.
    pub focal: f32,
    /// Between the two cameras, metres.
    pub baseline: f32,
    /// Principal point of the left camera, pixels.
    pub centre: [f32; 2],
    /// How much further right the right camera's principal point lies, pixels: added to disparities (Middlebury's `doffs`).
    pub offset: f32,
}

impl StereoCamera {
    /// Metres ahead of a pixel; 0 where its disparity is 0, what is not known, or says that it lies behind.
    pub fn depth(&self, disparity: f32) -> f32 {
        let shift = disparity + self.offset;
        let is_known = disparity > 0.0 && shift > 0.0;
        if is_known { self.focal * self.baseline / shift } else { 0.0 }
    }

    /// The place of the pixel whose middle is at `[x, y]`, `depth` metres ahead.
    pub fn point(&self, [x, y]: [f32; 2], depth: f32) -> [f32; 3] {
        let [right, down] = [x - self.centre[0], y - self.centre[1]].map(|off| off * depth / self.focal);
        [right, down, depth]
    }

    /// A point for each pixel of a map of depths, metres, `[height, width]`, of which something is known and that is nearer
    /// than `farthest`: x, y, z, with a picture of the same size also red, green and blue, 0..=255.
    ///
    /// # Errors
    /// `InvalidInput` when the picture or the map has another size than `size`, `[width, height]`.
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
                "a map of {} depths and its picture are not of {width}x{height} pixels; give those of one frame",
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
