//! A point cloud with its calibration: `opendr_msgs/PointCloudWithCalibration`.

use opendr_engine::data::PointCloudWithCalibration;
use opendr_engine::{Error, Result};
use opendr_messages::opendr_msgs;

use crate::{FromToMessage, RosBridge, header_from_message, message_from_header};

/// Point cloud and calibration, each as in its own message; an image size of 0 means unknown.
impl FromToMessage<opendr_msgs::PointCloudWithCalibration> for PointCloudWithCalibration {
    fn from_message(message: opendr_msgs::PointCloudWithCalibration, bridge: &RosBridge) -> Result<Self> {
        let shape = [message.image_height as usize, message.image_width as usize];
        Ok(Self {
            header: header_from_message(&message.header),
            cloud: bridge.from_message(message.cloud)?,
            calibration: bridge.from_message(message.calibration)?,
            image_shape: (shape != [0, 0]).then_some(shape),
        })
    }

    fn to_message(&self, bridge: &RosBridge) -> Result<opendr_msgs::PointCloudWithCalibration> {
        let side = |length: usize| {
            u32::try_from(length).map_err(|_| {
                Error::invalid_input(format!(
                    "the image has a side of {length} pixels; a message holds at most 4,294,967,295"
                ))
            })
        };
        let [image_height, image_width] = self.image_shape.unwrap_or_default();
        Ok(opendr_msgs::PointCloudWithCalibration {
            header: message_from_header(&self.header)?,
            cloud: bridge.to_message(&self.cloud)?,
            calibration: bridge.to_message(&self.calibration)?,
            image_height: side(image_height)?,
            image_width: side(image_width)?,
        })
    }
}
