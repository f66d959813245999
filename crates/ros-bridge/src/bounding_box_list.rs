//! 2D boxes: `vision_msgs/Detection2DArray`.

use opendr_engine::Result;
use opendr_engine::target::{BoundingBox, BoundingBoxList, Classes};
use opendr_messages::std_msgs::Header;
use opendr_messages::vision_msgs::{
    BoundingBox2D, Detection2D, Detection2DArray, ObjectHypothesis, ObjectHypothesisWithPose, Point2D, Pose2D,
};

use crate::class_id::name_from_class_id;
use crate::{FromToMessage, RosBridge, header_from_message, message_from_header};

/// One detection per box, with centre and size in pixels. Masks, face landmarks and the image id of a data set are not in the
/// message. The hypothesis with the highest score is read; a rotated box becomes its axis-aligned enclosing box.
impl FromToMessage<Detection2DArray> for BoundingBoxList {
    fn from_message(message: Detection2DArray, _: &RosBridge) -> Result<Self> {
        let boxes: Vec<_> = message.detections.iter().map(box_from_detection).collect();
        Ok(Self { header: header_from_message(&message.header), ..Self::from(boxes) })
    }

    fn to_message(&self, bridge: &RosBridge) -> Result<Detection2DArray> {
        let header = message_from_header(&self.header)?;
        let detection =
            |found: &BoundingBox| detection_from_box(found, &self.classes, &header, String::new(), bridge);
        Ok(Detection2DArray { detections: self.boxes.iter().map(detection).collect(), header })
    }
}

pub(crate) fn detection_from_box(
    found: &BoundingBox,
    classes: &Classes,
    header: &Header,
    id: String,
    bridge: &RosBridge,
) -> Detection2D {
    let [left, top, width, height] = [found.left, found.top, found.width, found.height].map(f64::from);
    let position = Point2D { x: left + width / 2.0, y: top + height / 2.0 };
    let hypothesis = ObjectHypothesis {
        class_id: bridge.class_ids.class_id(&found.name, classes),
        score: f64::from(found.confidence),
    };
    Detection2D {
        header: header.clone(),
        results: vec![ObjectHypothesisWithPose { hypothesis, ..Default::default() }],
        bbox: BoundingBox2D { center: Pose2D { position, theta: 0.0 }, size_x: width, size_y: height },
        id,
    }
}

pub(crate) fn box_from_detection(detection: &Detection2D) -> BoundingBox {
    let BoundingBox2D { center: Pose2D { position, theta }, size_x, size_y } = &detection.bbox;
    let (mut width, mut height) = (*size_x, *size_y);
    if *theta != 0.0 {
        let (sin, cos) = (theta.sin().abs(), theta.cos().abs());
        (width, height) = (size_x * cos + size_y * sin, size_x * sin + size_y * cos);
    }
    let best = best(detection.results.iter().map(|result| &result.hypothesis));
    let name = best.map(|hypothesis| name_from_class_id(&hypothesis.class_id)).unwrap_or_default();
    let [left, top] = [position.x - width / 2.0, position.y - height / 2.0].map(|edge| edge as f32);
    let confidence = best.map_or(0.0, |hypothesis| hypothesis.score as f32);
    BoundingBox::new(name, left, top, width as f32, height as f32, confidence)
}

/// Returns the hypothesis with the highest score; the first of equal or NaN ones.
pub(crate) fn best<'a>(
    hypotheses: impl Iterator<Item = &'a ObjectHypothesis>,
) -> Option<&'a ObjectHypothesis> {
    hypotheses.reduce(|best, next| if next.score > best.score { next } else { best })
}
