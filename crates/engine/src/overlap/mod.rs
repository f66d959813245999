//! How much boxes share: upright ones in a picture, turned ones on a plane, those that stand on it.
//!
//! Metrics, trackers and suppression in space measure by them.

mod rotated;
mod upright;

pub use rotated::{RotatedRectangle, StandingBox};
pub use upright::{image_cover, image_distance_overlap, image_generalised_overlap, image_overlap};
