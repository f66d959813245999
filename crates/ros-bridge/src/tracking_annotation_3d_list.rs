//! 3D tracks: `vision_msgs/Detection3DArray` with track ids.

use opendr_engine::Result;
use opendr_engine::target::{TrackingAnnotation3D, TrackingAnnotation3DList};
use opendr_messages::vision_msgs::Detection3DArray;

use crate::bounding_box_3d_list::{box_from_detection, detection_from_box};
use crate::tracking_annotation_list::track_id;
use crate::{FromToMessage, RosBridge, header_from_message, message_from_header};

/// As 3D boxes, with the track id as the detection's `id`. An `id` that is not a number is read as -1 (unknown).
impl FromToMessage<Detection3DArray> for TrackingAnnotation3DList {
    fn from_message(message: Detection3DArray, _: &RosBridge) -> Result<Self> {
        let annotation = |detection| TrackingAnnotation3D {
            bounding_box_3d: box_from_detection(detection),
            id: detection.id.parse().unwrap_or(-1),
            frame: None,
        };
        let annotations: Vec<_> = message.detections.iter().map(annotation).collect();
        Ok(Self { header: header_from_message(&message.header), ..Self::from(annotations) })
    }

    fn to_message(&self, bridge: &RosBridge) -> Result<Detection3DArray> {
        let header = message_from_header(&self.header)?;
        let detection = |annotation: &TrackingAnnotation3D| {
            let id = track_id(annotation.id);
            detection_from_box(&annotation.bounding_box_3d, &self.classes, &header, id, bridge)
        };
        Ok(Detection3DArray { detections: self.annotations.iter().map(detection).collect(), header })
    }
}
