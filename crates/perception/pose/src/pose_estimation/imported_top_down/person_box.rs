//! The region of a person that the network takes.

use opendr_engine::target::BoundingBox;
use opendr_vision::Warp;

use super::params::KeypointLayout;

/// Largest side of a region, in pixels of the image; larger ones come from damaged boxes.
const LARGEST: f64 = 1e6;

/// A padded box with the aspect ratio of the network's input, and its position in the input. Positions are those of pixel centres: the
/// first pixel is at (0, 0).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PersonBox {
    /// Left-top corner in the image.
    origin: [f64; 2],
    /// Width and height in the image.
    sides: [f64; 2],
    /// Width and height of the input, from the first to the last position for unbiased coordinates.
    spans: [f64; 2],
}

impl PersonBox {
    /// Returns the region of a box; `None` for one without an area, or with numbers that are not finite.
    pub fn around(
        found: &BoundingBox,
        size: [usize; 2],
        padding: f32,
        layout: KeypointLayout,
    ) -> Option<Self> {
        let [left, top, width, height] = [found.left, found.top, found.width, found.height].map(f64::from);
        let spans = match layout {
            KeypointLayout::UdpHeatmaps => size.map(|side| side as f64 - 1.0),
            _ => size.map(|side| side as f64),
        };
        let aspect = size[0] as f64 / size[1] as f64;
        // The shorter side grows to the aspect ratio of the input.
        let sides = [width.max(height * aspect), height.max(width / aspect)];
        let sides = sides.map(|side| side * f64::from(padding));
        let origin = [left + width / 2.0 - sides[0] / 2.0, top + height / 2.0 - sides[1] / 2.0];
        let is_usable = width > 0.0
            && height > 0.0
            && sides.iter().chain(&origin).all(|value| value.abs() <= LARGEST)
            && spans.iter().all(|span| *span >= 1.0);
        is_usable.then_some(Self { origin, sides, spans })
    }

    /// Returns the map from the network's input to the image.
    pub fn warp(&self) -> Warp {
        let scale = [0, 1].map(|axis| self.sides[axis] / self.spans[axis]);
        // The centre of the first pixel of the input is at the origin, whose own centre is half a pixel from its corner.
        let origin = [0, 1].map(|axis| self.origin[axis] + 0.5 - 0.5 * scale[axis]);
        Warp::upright(origin, scale)
    }

    /// Maps a position, as shares of the spans of the input, to the image.
    pub fn image_position(&self, shares: [f64; 2]) -> [f32; 2] {
        [0, 1].map(|axis| (self.origin[axis] + shares[axis] * self.sides[axis]) as f32)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn regions_have_the_aspect_of_the_input() {
        let found =
            BoundingBox { left: 10.0, top: 20.0, width: 30.0, height: 60.0, ..BoundingBox::default() };
        let region = PersonBox::around(&found, [48, 64], 1.25, KeypointLayout::Simcc).unwrap();
        assert_eq!(region.sides, [56.25, 75.0]);
        assert_eq!(region.image_position([0.5; 2]), [25.0, 50.0]);
        // The centre of the input's middle pixel is the centre of the image's.
        assert_eq!(region.warp().image_from_crop([24.5, 32.5]), [25.5, 50.5]);
        let wide = BoundingBox { width: 90.0, ..found };
        let region = PersonBox::around(&wide, [48, 64], 1.0, KeypointLayout::UdpHeatmaps).unwrap();
        assert_eq!((region.sides, region.spans), ([90.0, 120.0], [47.0, 63.0]));
    }

    #[test]
    fn damaged_boxes_have_no_region() {
        for [width, height] in [[0.0, 5.0], [5.0, -1.0], [f32::NAN, 5.0], [f32::INFINITY, 5.0], [1e9, 5.0]] {
            let found = BoundingBox { width, height, ..BoundingBox::default() };
            assert_eq!(PersonBox::around(&found, [48, 64], 1.25, KeypointLayout::Simcc), None);
        }
    }
}
