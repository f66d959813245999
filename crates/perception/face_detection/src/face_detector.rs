//! The face detector that other learners contain as a part.

use opendr_engine::data::Image;
use opendr_engine::learner::Learner;
use opendr_engine::model::Model;
use opendr_engine::target::{BoundingBox, BoundingBoxList};
use opendr_engine::{Device, Result};
use opendr_vision::Similarity;

use crate::face_detection::{Yunet, YunetParams};

/// Name of the part of the container.
const DETECTOR: &str = "detector";

opendr_engine::choices! {
    /// Content of the images for a learner of faces.
    pub enum FaceInput {
        /// A whole frame, in which the faces are detected.
        Frame = "frame",
        /// One cropped face: the whole image.
        Face = "face",
    }
}

/// A face detector with five points per face.
pub struct FaceDetector {
    detector: Yunet,
}

impl FaceDetector {
    /// Opens the part `detector` of `model`, with `threshold` as the minimum score of faces.
    pub fn open(model: &Model, threshold: f32, device: Device) -> Result<Self> {
        let params = YunetParams { threshold, ..YunetParams::default() };
        Ok(Self { detector: Yunet::load(&model.part(DETECTOR)?, params, device)? })
    }

    /// Fills `faces` with the faces in `image` that have an area and five finite points, highest score first.
    pub fn detect(&self, image: &Image, faces: &mut BoundingBoxList) -> Result<()> {
        self.detector.infer_into(&mut (), image, faces)?;
        let is_finite = |point: &[f32; 2]| point.iter().all(|value| value.is_finite());
        faces.boxes.retain(|face| {
            face.area() > 0.0 && face.landmarks.len() == 5 && face.landmarks.iter().all(is_finite)
        });
        Ok(())
    }
}

/// Returns the face with the largest area.
pub fn largest_face(faces: &BoundingBoxList) -> Option<&BoundingBox> {
    faces.boxes.iter().max_by(|one, other| one.area().total_cmp(&other.area()))
}

/// Returns the angle of the line from eye to eye, the first two of a face's points; 0 without them.
pub fn eye_angle(face: &BoundingBox) -> f32 {
    let eyes = face.landmarks.first_chunk::<2>();
    eyes.map_or(0.0, |[from, to]| (to[1] - from[1]).atan2(to[0] - from[0]))
}

/// Returns the square around a face's box, with `scale` times its longer side, rotated by `angle`, as a crop of `side`
/// pixels.
pub fn square_around(face: &BoundingBox, scale: f32, angle: f32, side: usize) -> Similarity {
    let centre = [face.left + face.width / 2.0, face.top + face.height / 2.0];
    Similarity::rotated_square(centre, scale * face.width.max(face.height), angle, side)
}

/// Returns the whole image as a crop of `side` pixels; its longer side fills it.
pub fn whole_image(image: &Image, side: usize) -> Similarity {
    let [width, height] = [image.width(), image.height()].map(|side| side as f32);
    Similarity::rotated_square([width / 2.0, height / 2.0], width.max(height), 0.0, side)
}
