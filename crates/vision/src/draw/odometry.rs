//! Drawing of the pose of a camera.

use opendr_engine::data::Image;
use opendr_engine::target::{Odometry, RigidPose};

use crate::draw::canvas::Canvas;
use crate::draw::label::draw_chip;
use crate::draw::palette::colour_of_index;
use crate::draw::style::Style;
use crate::draw::text::Text;

/// Writes the position into the left-top corner of `image`, which is converted to RGB `u8` where needed.
pub fn draw_odometry(image: &mut Image, odometry: &Odometry, style: &Style) {
    let mut canvas = Canvas::over(image);
    let unit = style.letter_unit(&canvas);
    let text = match odometry.pose {
        Some(RigidPose { position: [x, y, z], .. }) => format!("x {x:.2} y {y:.2} z {z:.2} m"),
        None => "pose unknown".to_owned(),
    };
    let class = if odometry.pose.is_some() { 0 } else { 1 };
    let colour = style.colour.unwrap_or_else(|| colour_of_index(class));
    draw_chip(&mut canvas, &Text::new(&text, unit), [unit; 2], colour);
}
