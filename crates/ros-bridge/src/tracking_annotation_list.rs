//! 2D tracks: `vision_msgs/Detection2DArray` with track ids.

use opendr_engine::Result;
use opendr_engine::target::{TrackingAnnotation, TrackingAnnotationList};
use opendr_messages::vision_msgs::Detection2DArray;

use crate::bounding_box_list::{box_from_detection, detection_from_box};
use crate::{FromToMessage, RosBridge, header_from_message, message_from_header};

/// As boxes, with the track id as the detection's `id`. The frame index is not in the message; the stamp identifies the frame. An
/// `id` that is not a number is read as -1 (unknown).
impl FromToMessage<Detection2DArray> for TrackingAnnotationList {
    fn from_message(message: Detection2DArray, _: &RosBridge) -> Result<Self> {
        let annotation = |detection| TrackingAnnotation {
            bounding_box: box_from_detection(detection),
            id: detection.id.parse().unwrap_or(-1),
            frame: None,
        };
        let annotations: Vec<_> = message.detections.iter().map(annotation).collect();
        Ok(Self { header: header_from_message(&message.header), ..Self::from(annotations) })
    }

    fn to_message(&self, bridge: &RosBridge) -> Result<Detection2DArray> {
        let header = message_from_header(&self.header)?;
        let detection = |annotation: &TrackingAnnotation| {
            let id = track_id(annotation.id);
            detection_from_box(&annotation.bounding_box, &self.classes, &header, id, bridge)
        };
        Ok(Detection2DArray { detections: self.annotations.iter().map(detection).collect(), header })
    }
}

/// Returns the text of a track id; empty if it is unknown.
pub(crate) fn track_id(id: i64) -> String {
    if id < 0 { String::new() } else { id.to_string() }
}
