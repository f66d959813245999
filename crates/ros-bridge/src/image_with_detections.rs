//! An image with boxes: `opendr_msgs/ImageWithDetections`.

use opendr_engine::Result;
use opendr_engine::data::ImageWithDetections;
use opendr_messages::opendr_msgs;

use crate::{FromToMessage, RosBridge, header_from_message, message_from_header};

/// Image and boxes, each as in its own message.
impl FromToMessage<opendr_msgs::ImageWithDetections> for ImageWithDetections {
    fn from_message(message: opendr_msgs::ImageWithDetections, bridge: &RosBridge) -> Result<Self> {
        Ok(Self {
            header: header_from_message(&message.header),
            image: bridge.from_message(message.image)?,
            boxes: bridge.from_message(message.detections)?,
        })
    }

    fn to_message(&self, bridge: &RosBridge) -> Result<opendr_msgs::ImageWithDetections> {
        Ok(opendr_msgs::ImageWithDetections {
            header: message_from_header(&self.header)?,
            image: bridge.to_message(&self.image)?,
            detections: bridge.to_message(&self.boxes)?,
        })
    }
}
