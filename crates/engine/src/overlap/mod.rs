//! Overlap of boxes: axis-aligned ones in an image, rotated rectangles on a plane, and 3D boxes that stand on it.
//!
//! Metrics, trackers and 3D non-maximum suppression use these functions.

mod rotated;
mod upright;

pub use rotated::{RotatedRectangle, StandingBox};
pub use upright::{image_cover, image_distance_overlap, image_generalised_overlap, image_overlap};
