//! Drawing of the pose of a camera.

use opendr_engine::data::Image;
use opendr_engine::target::{Odometry, RigidPose};

use crate::draw::label::draw_in_corner;
use crate::draw::style::Style;

/// Writes the position into the left-top corner of `image`, which is converted to RGB `u8` where needed.
pub fn draw_odometry(image: &mut Image, odometry: &Odometry, style: &Style) {
    match odometry.pose {
        Some(RigidPose { position: [x, y, z], .. }) => {
            draw_in_corner(image, &format!("x {x:.2} y {y:.2} z {z:.2} m"), 0, style);
        }
        None => draw_in_corner(image, "pose unknown", 1, style),
    }
}
