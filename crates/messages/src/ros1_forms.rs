//! Conversion of messages whose fields differ between ROS 1 and ROS 2.
//!
//! vision_msgs 0.0.2 has integer class ids where 4.x has strings; a string that is not a number becomes -1. Fields that only ROS 2
//! has (textures of markers) are omitted.

use crate::{opendr_msgs, ros1, vision_msgs, visualization_msgs};

/// Returns the class id of a string; -1 if it is not a number.
fn id_from_class(class: &str) -> i64 {
    class.parse().unwrap_or(-1)
}

impl From<&vision_msgs::ObjectHypothesis> for ros1::vision_msgs::ObjectHypothesis {
    fn from(hypothesis: &vision_msgs::ObjectHypothesis) -> Self {
        Self { id: id_from_class(&hypothesis.class_id), score: hypothesis.score }
    }
}

impl From<ros1::vision_msgs::ObjectHypothesis> for vision_msgs::ObjectHypothesis {
    fn from(hypothesis: ros1::vision_msgs::ObjectHypothesis) -> Self {
        Self { class_id: hypothesis.id.to_string(), score: hypothesis.score }
    }
}

impl From<&vision_msgs::ObjectHypothesisWithPose> for ros1::vision_msgs::ObjectHypothesisWithPose {
    fn from(result: &vision_msgs::ObjectHypothesisWithPose) -> Self {
        let id = id_from_class(&result.hypothesis.class_id);
        Self { id, score: result.hypothesis.score, pose: result.pose.clone() }
    }
}

impl From<ros1::vision_msgs::ObjectHypothesisWithPose> for vision_msgs::ObjectHypothesisWithPose {
    fn from(result: ros1::vision_msgs::ObjectHypothesisWithPose) -> Self {
        let hypothesis =
            vision_msgs::ObjectHypothesis { class_id: result.id.to_string(), score: result.score };
        Self { hypothesis, pose: result.pose }
    }
}

impl From<&vision_msgs::Classification> for ros1::vision_msgs::Classification2D {
    fn from(message: &vision_msgs::Classification) -> Self {
        let results = message.results.iter().map(Into::into).collect();
        Self { header: message.header.clone(), results, source_img: Default::default() }
    }
}

impl From<ros1::vision_msgs::Classification2D> for vision_msgs::Classification {
    fn from(message: ros1::vision_msgs::Classification2D) -> Self {
        Self { header: message.header, results: message.results.into_iter().map(Into::into).collect() }
    }
}

impl From<&vision_msgs::BoundingBox2D> for ros1::vision_msgs::BoundingBox2D {
    fn from(bbox: &vision_msgs::BoundingBox2D) -> Self {
        let vision_msgs::Pose2D { position: vision_msgs::Point2D { x, y }, theta } = bbox.center;
        let center = crate::geometry_msgs::Pose2D { x, y, theta };
        Self { center, size_x: bbox.size_x, size_y: bbox.size_y }
    }
}

impl From<ros1::vision_msgs::BoundingBox2D> for vision_msgs::BoundingBox2D {
    fn from(bbox: ros1::vision_msgs::BoundingBox2D) -> Self {
        let crate::geometry_msgs::Pose2D { x, y, theta } = bbox.center;
        let center = vision_msgs::Pose2D { position: vision_msgs::Point2D { x, y }, theta };
        Self { center, size_x: bbox.size_x, size_y: bbox.size_y }
    }
}

impl From<&vision_msgs::BoundingBox2DArray> for ros1::vision_msgs::BoundingBox2DArray {
    fn from(message: &vision_msgs::BoundingBox2DArray) -> Self {
        Self { header: message.header.clone(), boxes: message.boxes.iter().map(Into::into).collect() }
    }
}

impl From<ros1::vision_msgs::BoundingBox2DArray> for vision_msgs::BoundingBox2DArray {
    fn from(message: ros1::vision_msgs::BoundingBox2DArray) -> Self {
        Self { header: message.header, boxes: message.boxes.into_iter().map(Into::into).collect() }
    }
}

macro_rules! detections {
    ($($detection:ident $array:ident $source:ident),*) => {$(
        impl From<&vision_msgs::$detection> for ros1::vision_msgs::$detection {
            fn from(detection: &vision_msgs::$detection) -> Self {
                Self {
                    header: detection.header.clone(),
                    results: detection.results.iter().map(Into::into).collect(),
                    bbox: (&detection.bbox).into(),
                    $source: Default::default(),
                    is_tracking: !detection.id.is_empty(),
                    tracking_id: detection.id.clone(),
                }
            }
        }

        impl From<ros1::vision_msgs::$detection> for vision_msgs::$detection {
            fn from(detection: ros1::vision_msgs::$detection) -> Self {
                Self {
                    header: detection.header,
                    results: detection.results.into_iter().map(Into::into).collect(),
                    bbox: detection.bbox.into(),
                    id: detection.tracking_id,
                }
            }
        }

        impl From<&vision_msgs::$array> for ros1::vision_msgs::$array {
            fn from(message: &vision_msgs::$array) -> Self {
                let detections = message.detections.iter().map(Into::into).collect();
                Self { header: message.header.clone(), detections }
            }
        }

        impl From<ros1::vision_msgs::$array> for vision_msgs::$array {
            fn from(message: ros1::vision_msgs::$array) -> Self {
                Self { header: message.header, detections: message.detections.into_iter().map(Into::into).collect() }
            }
        }
    )*};
}

detections!(Detection2D Detection2DArray source_img, Detection3D Detection3DArray source_cloud);

/// 3D boxes are equal in both versions.
impl From<&Self> for vision_msgs::BoundingBox3D {
    fn from(bbox: &Self) -> Self {
        bbox.clone()
    }
}

impl From<&opendr_msgs::ImageWithDetections> for ros1::opendr_msgs::ImageWithDetections {
    fn from(message: &opendr_msgs::ImageWithDetections) -> Self {
        let (header, image) = (message.header.clone(), message.image.clone());
        Self { header, image, detections: (&message.detections).into() }
    }
}

impl From<ros1::opendr_msgs::ImageWithDetections> for opendr_msgs::ImageWithDetections {
    fn from(message: ros1::opendr_msgs::ImageWithDetections) -> Self {
        Self { header: message.header, image: message.image, detections: message.detections.into() }
    }
}

macro_rules! same_fields {
    ($from:ty => $to:ty, $($field:ident),*; $($rest:ident)*) => {
        impl From<&$from> for $to {
            fn from(message: &$from) -> Self {
                Self { $($field: message.$field.clone(),)* }
            }
        }

        impl From<$to> for $from {
            fn from(message: $to) -> Self {
                Self { $($field: message.$field,)* $($rest: Default::default(),)* }
            }
        }
    };
}

same_fields!(visualization_msgs::Marker => ros1::visualization_msgs::Marker,
    header, ns, id, r#type, action, pose, scale, color, lifetime, frame_locked, points, colors, text, mesh_resource,
    mesh_use_embedded_materials; texture_resource texture uv_coordinates mesh_file);

impl From<&visualization_msgs::MarkerArray> for ros1::visualization_msgs::MarkerArray {
    fn from(message: &visualization_msgs::MarkerArray) -> Self {
        Self { markers: message.markers.iter().map(Into::into).collect() }
    }
}

impl From<ros1::visualization_msgs::MarkerArray> for visualization_msgs::MarkerArray {
    fn from(message: ros1::visualization_msgs::MarkerArray) -> Self {
        Self { markers: message.markers.into_iter().map(Into::into).collect() }
    }
}
