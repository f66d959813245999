//! Drawing of predictions onto images: boxes with labels, skeletons, masks, heatmaps, tracks.

mod bounding_boxes;
mod canvas;
mod category;
mod colour_map;
mod contact_sheet;
mod coverage;
mod glyphs;
mod grid;
mod heatmap;
mod label;
mod landmarks;
mod mask;
mod odometry;
mod palette;
mod polygons;
mod poses;
mod score_mask;
mod style;
mod text;
mod text_regions;
mod tracks;

#[cfg(test)]
mod tests;

pub use bounding_boxes::draw_bounding_boxes;
pub use canvas::{Canvas, Corners, Point};
pub use category::draw_category;
pub use contact_sheet::contact_sheet;
pub use heatmap::draw_heatmap;
pub use mask::draw_mask;
pub use odometry::draw_odometry;
pub use palette::{COLOURS, Colour, colour_of_index, colour_of_name};
pub use poses::draw_poses;
pub use score_mask::draw_score_mask;
pub use style::Style;
pub use text_regions::draw_text_regions;
pub use tracks::{Trails, draw_tracks};

use opendr_engine::ValueRef;
use opendr_engine::data::Image;

/// Draws a target of any type onto `image`; a type without a position in an image leaves it unchanged.
///
/// Tracks are drawn without trails, which need a state: [`draw_tracks`].
pub fn draw<'a>(image: &mut Image, target: impl Into<ValueRef<'a>>, style: &Style) {
    match target.into() {
        ValueRef::BoundingBoxList(boxes) => draw_bounding_boxes(image, boxes, style),
        ValueRef::TrackingAnnotationList(tracks) => draw_tracks(image, tracks, &Trails::default(), style),
        ValueRef::PoseList(poses) => draw_poses(image, poses, style),
        ValueRef::Category(category) => draw_category(image, category, style),
        ValueRef::Heatmap(map) => draw_heatmap(image, map, style),
        ValueRef::Odometry(odometry) => draw_odometry(image, odometry, style),
        ValueRef::TextRegionList(regions) => draw_text_regions(image, regions, style),
        _ => {}
    }
}
