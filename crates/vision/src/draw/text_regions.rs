//! Drawing of text regions.

use opendr_engine::data::Image;
use opendr_engine::target::{TextRegion, TextRegionList};

use crate::draw::bounding_boxes::whole_corners;
use crate::draw::canvas::Canvas;
use crate::draw::label::Labels;
use crate::draw::palette::colour_of_index;
use crate::draw::style::Style;

/// Draws the outlines of text regions with their texts onto `image`, which is converted to RGB `u8` where needed. Regions with corners
/// that are not finite are omitted.
pub fn draw_text_regions(image: &mut Image, regions: &TextRegionList, style: &Style) {
    let mut canvas = Canvas::over(image);
    let (thickness, unit) = (style.thickness(&canvas), style.letter_unit(&canvas));
    let colour = style.colour.unwrap_or_else(|| colour_of_index(0));
    let is_finite = |region: &&TextRegion| region.corners.iter().flatten().all(|number| number.is_finite());
    for region in regions.regions.iter().filter(is_finite) {
        let nexts = region.corners.iter().cycle().skip(1);
        for (from, to) in region.corners.iter().zip(nexts) {
            canvas.line(*from, *to, thickness, colour, 1.0);
        }
    }
    if !style.labels {
        return;
    }
    let mut labels = Labels::default();
    for region in regions.regions.iter().filter(is_finite) {
        let [left, top, width, height] = region.bounding_box();
        let Some(corners) = whole_corners([left, top, left + width, top + height]) else { continue };
        let name = &region.text;
        let text =
            if style.show_confidences { format!("{name} {:.2}", region.confidence) } else { name.clone() };
        labels.draw(&mut canvas, [&text, name], corners, [unit, thickness], colour);
    }
}
