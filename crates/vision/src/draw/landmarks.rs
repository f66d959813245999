//! Drawing of landmarks: eyes, nose and mouth of a face.

use crate::draw::canvas::{Canvas, Point};
use crate::draw::palette::Colour;

/// Draws points as bright dots with a rim in `colour`.
pub(super) fn draw_landmarks(canvas: &mut Canvas<'_>, points: &[Point], thickness: f32, colour: Colour) {
    for point in points {
        canvas.disc(*point, thickness * 1.4, colour, 1.0);
        canvas.disc(*point, thickness * 0.7, [255; 3], 1.0);
    }
}
