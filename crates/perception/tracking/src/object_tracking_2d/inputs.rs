//! Inputs of the trackers of detections, and their output.

use opendr_engine::Result;
use opendr_engine::data::Image;
use opendr_engine::learner::Inputs;
use opendr_engine::target::{BoundingBoxList, Name, TrackingAnnotation, TrackingAnnotationList};

use crate::tracking::ValidBox;
use crate::tracking::camera_motion::{CameraMotion, SimilarityMotion};

/// The detections in a frame.
#[derive(Debug, Clone, Copy, Inputs)]
pub struct TrackerInputs<'a> {
    /// Detections in the frame, with their scores.
    pub detections: &'a BoundingBoxList,
    /// Frame, from which the motion of the camera is estimated. Either all frames of a stream have one, or none.
    pub image: Option<&'a Image>,
}

impl TrackerInputs<'_> {
    /// Returns the motion of the camera since the last frame; `None` without an image or without motion.
    pub(crate) fn motion(
        &self,
        camera: &mut CameraMotion,
        boxes: &[ValidBox],
    ) -> Result<Option<SimilarityMotion>> {
        let motion = self.image.map(|image| camera.update(image, boxes)).transpose()?;
        Ok(motion.filter(|motion| *motion != SimilarityMotion::NONE))
    }

    /// Clears the output for a frame.
    pub(crate) fn begin(&self, target: &mut TrackingAnnotationList) {
        target.annotations.clear();
        target.classes.clone_from(&self.detections.classes);
        target.action = None;
    }

    /// Writes the detection at `index` as the object `id` into `target`.
    pub(crate) fn write(&self, index: usize, id: i64, frame: i64, target: &mut TrackingAnnotationList) {
        if let Some(found) = self.detections.boxes.get(index) {
            target.annotations.push(TrackingAnnotation {
                bounding_box: found.clone(),
                id,
                frame: Some(frame),
            });
        }
    }

    /// Returns the class of the detection at `index`.
    pub(crate) fn name(&self, index: usize) -> Option<&Name> {
        self.detections.boxes.get(index).map(|found| &found.name)
    }
}
