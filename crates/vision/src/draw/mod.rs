//! Drawing what was found onto pictures: boxes with labels, skeletons, masks, heat maps, tracks.

mod bounding_boxes;
mod canvas;
mod glyphs;
mod label;
mod landmarks;
mod palette;
mod poses;
mod style;
mod text;

#[cfg(test)]
mod tests;

pub use bounding_boxes::draw_bounding_boxes;
pub use canvas::{Canvas, Corners, Point};
pub use palette::{COLOURS, Colour, colour_of_index, colour_of_name};
pub use poses::draw_poses;
pub use style::Style;

use opendr_engine::ValueRef;
use opendr_engine::data::Image;

/// Draws a target of any type onto `image`; a type that has no picture leaves it as it is.
pub fn draw<'a>(image: &mut Image, target: impl Into<ValueRef<'a>>, style: &Style) {
    match target.into() {
        ValueRef::BoundingBoxList(boxes) => draw_bounding_boxes(image, boxes, style),
        ValueRef::PoseList(poses) => draw_poses(image, poses, style),
        _ => {}
    }
}
