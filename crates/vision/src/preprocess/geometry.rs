//! Position of an image in a network's input, and the inverse mapping.

/// Alignment of a letterboxed image in the input; the rest is padding.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum LetterboxAlign {
    /// Equal padding on opposite sides; an odd pixel is added on the right and at the bottom.
    Centre,
    /// Padding on the right and at the bottom only.
    TopLeft,
    /// The same, with sides that are truncated instead of rounded to whole pixels, and one scale for both axes (YOLOX).
    TopLeftTruncated,
}

/// Maps positions in a network's input to the image that it was made from.
///
/// Positions are continuous: the left-top corner of the first pixel is (0, 0), its centre (0.5, 0.5).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct InputGeometry {
    /// Width and height of the image, in pixels.
    pub image_size: [f32; 2],
    /// Image pixels per input pixel, along x and y.
    pub scale: [f32; 2],
    /// Left-top corner of the image in the input, in input pixels.
    pub offset: [f32; 2],
}

impl InputGeometry {
    /// Maps a point `[x, y]` of the input to pixels of the image; the result may be outside the image.
    pub fn image_from_input(&self, [x, y]: [f32; 2]) -> [f32; 2] {
        [(x - self.offset[0]) * self.scale[0], (y - self.offset[1]) * self.scale[1]]
    }

    /// Maps a point `[x, y]` of the image to pixels of the input.
    pub fn input_from_image(&self, [x, y]: [f32; 2]) -> [f32; 2] {
        [x / self.scale[0] + self.offset[0], y / self.scale[1] + self.offset[1]]
    }

    /// Maps a box `[left, top, right, bottom]` of the input to pixels of the image and clips it to the image.
    pub fn image_box_from_input(&self, [left, top, right, bottom]: [f32; 4]) -> [f32; 4] {
        let [width, height] = self.image_size;
        let [left, top] = self.image_from_input([left, top]);
        let [right, bottom] = self.image_from_input([right, bottom]);
        [left.clamp(0.0, width), top.clamp(0.0, height), right.clamp(0.0, width), bottom.clamp(0.0, height)]
    }
}

/// Rectangle of the input that the image covers, in input pixels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Placement {
    pub(super) x: usize,
    pub(super) y: usize,
    pub(super) width: usize,
    pub(super) height: usize,
    /// Image pixels per input pixel, where it does not follow from the sides.
    pub(super) scale: Option<f32>,
}

impl Placement {
    /// Returns the placement that fills the input and changes the aspect ratio.
    pub(super) fn stretch([width, height]: [usize; 2]) -> Self {
        Self { x: 0, y: 0, width, height, scale: None }
    }

    /// Returns the placement that keeps the aspect ratio and fills the input along one axis.
    pub(super) fn letterbox(source: [usize; 2], target: [usize; 2], anchor: LetterboxAlign) -> Self {
        let scale = (target[0] as f64 / source[0] as f64).min(target[1] as f64 / source[1] as f64);
        let is_truncated = anchor == LetterboxAlign::TopLeftTruncated;
        let whole = |side: f64| if is_truncated { side.trunc() } else { side.round() };
        let side = |axis: usize| (whole(source[axis] as f64 * scale) as usize).clamp(1, target[axis]);
        let (width, height) = (side(0), side(1));
        let (x, y) = match anchor {
            LetterboxAlign::Centre => ((target[0] - width) / 2, (target[1] - height) / 2),
            LetterboxAlign::TopLeft | LetterboxAlign::TopLeftTruncated => (0, 0),
        };
        Self { x, y, width, height, scale: is_truncated.then_some((1.0 / scale) as f32) }
    }

    /// Returns the mapping from the input to an image of `source` pixels with this placement.
    pub(super) fn geometry(&self, source: [usize; 2]) -> InputGeometry {
        InputGeometry {
            image_size: source.map(|side| side as f32),
            scale: self.scale.map_or_else(
                || [source[0] as f32 / self.width as f32, source[1] as f32 / self.height as f32],
                |scale| [scale; 2],
            ),
            offset: [self.x as f32, self.y as f32],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn letterbox_keeps_the_ratio_and_maps_back() {
        let placement = Placement::letterbox([1920, 1080], [416, 416], LetterboxAlign::Centre);
        assert_eq!(placement, Placement { x: 0, y: 91, width: 416, height: 234, scale: None });
        let geometry = placement.geometry([1920, 1080]);
        assert_eq!(geometry.image_from_input([208.0, 208.0]), [960.0, 540.0]);
        assert_eq!(geometry.image_box_from_input([-5.0, 0.0, 416.0, 416.0]), [0.0, 0.0, 1920.0, 1080.0]);
        let there = geometry.input_from_image([100.0, 200.0]);
        let back = geometry.image_from_input(there);
        assert!((back[0] - 100.0).abs() < 1e-3 && (back[1] - 200.0).abs() < 1e-3);
    }

    #[test]
    fn slivers_keep_a_pixel() {
        let placement = Placement::letterbox([10_000, 1], [64, 64], LetterboxAlign::TopLeft);
        assert_eq!(placement, Placement { x: 0, y: 0, width: 64, height: 1, scale: None });
    }

    #[test]
    fn truncated_sides_have_one_scale() {
        let placement = Placement::letterbox([640, 427], [416, 416], LetterboxAlign::TopLeftTruncated);
        assert_eq!((placement.width, placement.height), (416, 277));
        assert_eq!(Placement::letterbox([640, 427], [416, 416], LetterboxAlign::TopLeft).height, 278);
        let [x, y] = placement.geometry([640, 427]).scale;
        assert!((x - 640.0 / 416.0).abs() < 1e-6 && x == y);
    }
}
