//! Drawing of boxes with labels.

use opendr_engine::data::Image;
use opendr_engine::target::{BoundingBox, BoundingBoxList};

use crate::draw::canvas::{Canvas, Corners};
use crate::draw::label::Labels;
use crate::draw::landmarks::draw_landmarks;
use crate::draw::mask;
use crate::draw::palette::colour_of_name;
use crate::draw::style::Style;

/// Draws boxes with class, score, landmarks and mask (where they have a segment) onto `image`, which is converted to
/// RGB `u8` where needed.
///
/// Earlier boxes of the list are drawn on top of later ones. Boxes are clipped at the border; those without an area
/// are omitted.
pub fn draw_bounding_boxes(image: &mut Image, boxes: &BoundingBoxList, style: &Style) {
    let mut canvas = Canvas::over(image);
    let (thickness, unit) = (style.thickness(&canvas), style.letter_unit(&canvas));
    let colour = |found: &BoundingBox| style.colour.unwrap_or_else(|| colour_of_name(&found.name));
    for found in boxes.boxes.iter().rev() {
        if let Some(segment) = &found.segment {
            mask::cover(&mut canvas, &segment.segmentation, colour(found), style.opacity, thickness);
        }
        if let Some(corners) = whole_corners(found.corners()) {
            outline(&mut canvas, corners, thickness, colour(found));
        }
        draw_landmarks(&mut canvas, &found.landmarks, thickness, colour(found));
    }
    if !style.labels {
        return;
    }
    let mut labels = Labels::default();
    for found in &boxes.boxes {
        let Some(corners) = whole_corners(found.corners()) else { continue };
        let name = boxes.label(found).map_or_else(|| found.name.to_string(), str::to_owned);
        let text =
            if style.show_confidences { format!("{name} {:.2}", found.confidence) } else { name.clone() };
        labels.draw(&mut canvas, [&text, &name], corners, [unit, thickness], colour(found));
    }
}

/// Draws a rectangle's outline in `colour` with a thin dark rim, for contrast on any background; its edges lie on
/// whole pixels when `corners` and `thickness` do.
pub(super) fn outline(canvas: &mut Canvas<'_>, corners: Corners, thickness: f32, colour: [u8; 3]) {
    let corners = corners.map(|edge| edge + (thickness / 2.0).fract());
    if thickness >= 2.0 {
        canvas.outline(corners, thickness + 2.0, [0; 3], 0.25);
    }
    canvas.outline(corners, thickness, colour, 1.0);
}

/// Rounds corners to whole pixels; `None` when there is no area.
pub(super) fn whole_corners([x0, y0, x1, y1]: Corners) -> Option<Corners> {
    (x0 < x1 && y0 < y1).then(|| [x0, y0, x1, y1].map(f32::round))
}
