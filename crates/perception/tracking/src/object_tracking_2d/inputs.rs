//! What trackers of detections are given, and what they answer of it.

use opendr_engine::Result;
use opendr_engine::data::Image;
use opendr_engine::learner::Inputs;
use opendr_engine::target::{BoundingBoxList, Name, TrackingAnnotation, TrackingAnnotationList};

use crate::tracking::SoundBox;
use crate::tracking::camera_motion::{CameraMotion, PlaneMotion};

/// What was found in a frame.
#[derive(Debug, Clone, Copy, Inputs)]
pub struct TrackerInputs<'a> {
    /// What was found in the frame; the confidences count.
    pub detections: &'a BoundingBoxList,
    /// The frame, which tells how the camera moved. All frames of a stream, or none.
    pub image: Option<&'a Image>,
}

impl TrackerInputs<'_> {
    /// How the camera moved since the frame before; `None` where nothing tells.
    pub(crate) fn motion(
        &self,
        camera: &mut CameraMotion,
        boxes: &[SoundBox],
    ) -> Result<Option<PlaneMotion>> {
        let motion = self.image.map(|image| camera.next(image, boxes)).transpose()?;
        Ok(motion.filter(|motion| *motion != PlaneMotion::NONE))
    }

    /// Begins the answer to a frame.
    pub(crate) fn begin(&self, answer: &mut TrackingAnnotationList) {
        answer.annotations.clear();
        answer.classes.clone_from(&self.detections.classes);
        answer.action = None;
    }

    /// Answers the detection at `index` as object `id`.
    pub(crate) fn tell(&self, index: usize, id: i64, frame: i64, answer: &mut TrackingAnnotationList) {
        if let Some(found) = self.detections.boxes.get(index) {
            answer.annotations.push(TrackingAnnotation {
                bounding_box: found.clone(),
                id,
                frame: Some(frame),
            });
        }
    }

    /// The class of the detection at `index`.
    pub(crate) fn name(&self, index: usize) -> Option<&Name> {
        self.detections.boxes.get(index).map(|found| &found.name)
    }
}
