//! Classification of detected faces with and without a mask, by a small network beside the detector.

use opendr_engine::data::Image;
use opendr_engine::model::Model;
use opendr_engine::target::{BoundingBox, Classes};
use opendr_engine::{Device, Error, Result};
use opendr_perception_common::image_network::ImageNetwork;
use opendr_perception_common::manifest_preprocess::preprocess_from_manifest;
use opendr_vision::Similarity;

use crate::face_detector::{eye_angle, square_around};

/// Name of the part of the container, an image classifier.
const PART: &str = "mask";
const FILE: &str = "model.onnx";
/// Classes of the part and of the detector that contains it: OpenDR's.
const CLASSES: [&str; 2] = ["face", "masked face"];
/// Side of a crop in longer sides of the face's box.
const MARGIN: f32 = 1.25;
/// Mean and scale of levels 0..=255, for inputs of -1..=1.
const LEVEL: f32 = 127.5;

/// Returns the crop of a face with its five points for the network: a square, upright by the eyes.
pub fn mask_crop(face: &BoundingBox, side: usize) -> Similarity {
    square_around(face, MARGIN, eye_angle(face), side)
}

/// Classifier of faces with and without a mask.
pub(super) struct MaskNetwork {
    network: ImageNetwork,
    side: usize,
}

impl MaskNetwork {
    /// Opens the container's part, if there is one; `classes` are those of the container.
    ///
    /// # Errors
    /// `Format` when either has other classes than `face` and `masked face`; else as for any network.
    pub fn open(model: &Model, classes: &Classes, device: Device) -> Result<Option<Self>> {
        if !model.parts().any(|part| part == PART) {
            return Ok(None);
        }
        let part = model.part(PART)?;
        for classes in [classes, &part.manifest().classes] {
            if !classes.iter().eq(CLASSES) {
                return Err(Error::format(format!(
                    "a detector with a part {PART:?} and the part itself need the classes {CLASSES:?}; load another model"
                )));
            }
        }
        let network = ImageNetwork::open_file(&part, FILE, device, |input| {
            preprocess_from_manifest(&part, input, LEVEL)
        })?;
        let [side, _] = network.size();
        Ok(Some(Self { network, side }))
    }

    /// Sets the class of each face.
    pub fn name(&self, image: &Image, faces: &mut [BoundingBox]) -> Result<()> {
        for face in faces {
            let crop = mask_crop(face, self.side);
            if !crop.is_regular() {
                continue;
            }
            self.network.run_crop(image, &crop, |outputs| {
                let [bare, masked] = outputs[0].values::<f32>()? else {
                    return Err(Error::format(format!(
                        "{FILE} of the part {PART:?} does not have two classes; load another model"
                    )));
                };
                face.name = i64::from(masked > bare).into();
                Ok(())
            })?;
        }
        Ok(())
    }
}
