//! Parts of trackers: Kalman filters of boxes, association of tracks and detections, and the motion of the camera.
//!
//! The trackers of [`object_tracking_2d`](crate::object_tracking_2d) and [`object_tracking_3d`](crate::object_tracking_3d)
//! are built from these. Time is counted in frames.

pub mod camera_motion;

mod area_filter;
mod constant_velocity;
mod height_filter;
mod life;
mod pairing;
mod valid_boxes;

pub use area_filter::AreaFilter;
pub use constant_velocity::{Constant, ConstantVelocity};
pub use height_filter::HeightFilter;
pub use pairing::SparseAssignment;
pub use valid_boxes::{MAX_BOXES, ValidBox, valid_boxes};

pub(crate) use life::Life;

/// Returns centre, width and height of `[x0, y0, x1, y1]`.
fn middle_and_size([x0, y0, x1, y1]: [f64; 4]) -> [f64; 4] {
    [(x0 + x1) / 2.0, (y0 + y1) / 2.0, x1 - x0, y1 - y0]
}

/// Returns `[x0, y0, x1, y1]` of centre, width and height.
fn corners([x, y, width, height]: [f64; 4]) -> [f64; 4] {
    [x - width / 2.0, y - height / 2.0, x + width / 2.0, y + height / 2.0]
}
