//! 3D boxes: `vision_msgs/Detection3DArray`.

use opendr_engine::Result;
use opendr_engine::target::{BoundingBox3D, BoundingBox3DList, Classes};
use opendr_messages::geometry_msgs::{Point, Pose, PoseWithCovariance, Quaternion, Vector3};
use opendr_messages::std_msgs::Header;
use opendr_messages::vision_msgs::{
    BoundingBox3D as BoxMessage, Detection3D, Detection3DArray, ObjectHypothesis, ObjectHypothesisWithPose,
};

use crate::bounding_box_list::best;
use crate::class_id::name_from_class_id;
use crate::{FromToMessage, RosBridge, header_from_message, message_from_header};

/// One detection per box, in the camera frame of KITTI (x right, y down, z ahead): centre in metres, rotation about y as a
/// quaternion; length, height and width are the sizes along the box's x, y and z. Further fields of KITTI (truncation, occlusion,
/// observation angle, 2D box) are not in the message.
impl FromToMessage<Detection3DArray> for BoundingBox3DList {
    fn from_message(message: Detection3DArray, _: &RosBridge) -> Result<Self> {
        let boxes: Vec<_> = message.detections.iter().map(box_from_detection).collect();
        Ok(Self { header: header_from_message(&message.header), ..Self::from(boxes) })
    }

    fn to_message(&self, bridge: &RosBridge) -> Result<Detection3DArray> {
        let header = message_from_header(&self.header)?;
        let detection =
            |found: &BoundingBox3D| detection_from_box(found, &self.classes, &header, String::new(), bridge);
        Ok(Detection3DArray { detections: self.boxes.iter().map(detection).collect(), header })
    }
}

pub(crate) fn detection_from_box(
    found: &BoundingBox3D,
    classes: &Classes,
    header: &Header,
    id: String,
    bridge: &RosBridge,
) -> Detection3D {
    let [x, floor, z] = found.location.map(f64::from);
    let [length, height, width] = found.dimensions.map(f64::from);
    let half_turn = f64::from(found.rotation_y) / 2.0;
    let center = Pose {
        position: Point { x, y: floor - height / 2.0, z },
        orientation: Quaternion { x: 0.0, y: half_turn.sin(), z: 0.0, w: half_turn.cos() },
    };
    let hypothesis = ObjectHypothesis {
        class_id: bridge.class_ids.class_id(&found.name, classes),
        score: f64::from(found.confidence),
    };
    let pose = PoseWithCovariance { pose: center.clone(), ..Default::default() };
    Detection3D {
        header: header.clone(),
        results: vec![ObjectHypothesisWithPose { hypothesis, pose }],
        bbox: BoxMessage { center, size: Vector3 { x: length, y: height, z: width } },
        id,
    }
}

pub(crate) fn box_from_detection(detection: &Detection3D) -> BoundingBox3D {
    let BoxMessage { center: Pose { position, orientation }, size } = &detection.bbox;
    let Quaternion { x, y, z, w } = orientation;
    // Rotation about y of any orientation.
    let rotation_y = (2.0 * (w * y + x * z)).atan2(1.0 - 2.0 * (x * x + y * y));
    let best = best(detection.results.iter().map(|result| &result.hypothesis));
    BoundingBox3D {
        name: best.map(|hypothesis| name_from_class_id(&hypothesis.class_id)).unwrap_or_default(),
        truncated: -1.0,
        occluded: -1,
        alpha: (rotation_y - position.x.atan2(position.z)) as f32,
        bbox2d: [0.0; 4],
        dimensions: [size.x, size.y, size.z].map(|side| side as f32),
        location: [position.x, position.y + size.y / 2.0, position.z].map(|metres| metres as f32),
        rotation_y: rotation_y as f32,
        confidence: best.map_or(0.0, |hypothesis| hypothesis.score as f32),
    }
}
