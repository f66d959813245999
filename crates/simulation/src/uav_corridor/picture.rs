//! A picture of the flight.

use opendr_engine::Result;
use opendr_engine::data::Image;

use super::{CAMERA_HEIGHT, HALF_WIDTH, UavDepthCorridor};
use crate::raycast::{Camera, Pose, Shading, along};

/// What a colour camera beside the depth camera sees.
pub(super) fn picture(corridor: &UavDepthCorridor) -> Result<Image> {
    let camera = Camera::new(256, 256, HALF_WIDTH)?;
    let pose = corridor.pose();
    let pose = Pose { position: along(pose.position, pose.axes[2], CAMERA_HEIGHT), ..pose };
    Shading::default().picture(&camera, corridor.world().scene(), &pose, 60.0)
}
