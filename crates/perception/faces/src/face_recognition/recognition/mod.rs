//! Face recognition: faces are found, turned upright by five points, and compared with those of known persons.
//!
//! MobileFace gives 256 numbers a face (trained with ArcFace's loss: Deng et al., CVPR 2019); the cosine between two
//! faces tells whether they are of one person. Persons are made known by `fit`, which takes pictures of each as
//! references and trains nothing unless asked to: the set is open, and whoever is close to nobody is unknown.

#[cfg(feature = "training")]
mod fit;
mod gallery;
#[cfg(feature = "training")]
mod network;
#[cfg(feature = "training")]
mod objective;

use std::sync::Arc;

use opendr_engine::data::{Image, Layout};
use opendr_engine::learner::{Learner, Spec};
use opendr_engine::model::Model;
use opendr_engine::params::Params;
use opendr_engine::target::{BoundingBox, BoundingBoxList, Classes, Name};
use opendr_engine::{Device, Error, Pool, Result, Task};
use opendr_face_detection::face_finder::{FaceFinder, FaceInput, whole_picture};
use opendr_perception_common::picture_network::PictureNetwork;
use opendr_vision::{Preprocess, Similarity};

use gallery::{Gallery, normalise};

#[cfg(feature = "training")]
pub use fit::{FaceRecognitionFitParams, FaceRecognitionMode};

/// What a user may set.
#[derive(Debug, Clone, Params)]
pub struct FaceRecognitionParams {
    /// Faces whose cosine with every picture of a known person is below this are unknown.
    #[param(default = 0.38, range = -1.0..=1.0, live)]
    pub threshold: f32,
    /// What the detector scores below this is no face.
    #[param(default = 0.6, range = 0.0..=1.0)]
    pub face_threshold: f32,
    /// What pictures show.
    #[param(live)]
    pub picture: FaceInput,
}

/// A loaded face recogniser.
///
/// It answers a box for every face, best first, with the person's class, or the label `unknown`. A box's confidence is how
/// sure it is of that answer, 0.5..=1, by a logistic function of the cosine whose middle is the threshold. Its slope
/// makes 300 labelled pairs of faces most likely (deepface's test set; maximum likelihood, Brier score 0.017).
pub struct FaceRecognition {
    params: FaceRecognitionParams,
    finder: FaceFinder,
    network: PictureNetwork,
    gallery: Gallery,
    persons: Classes,
    unknown: Name,
    scratch: Pool<Scratch>,
}

#[derive(Default)]
struct Scratch {
    faces: BoundingBoxList,
    embedding: Vec<f32>,
}

/// Side of the network's input, pixels.
const SIDE: usize = 112;
/// Where ArcFace wants eyes, nose and corners of the mouth in it (insightface's `arcface_dst`).
const TEMPLATE: [[f32; 2]; 5] =
    [[38.2946, 51.6963], [73.5318, 51.5014], [56.0252, 71.7366], [41.5493, 92.3655], [70.7299, 92.2041]];
/// Of the confidence as a function of the cosine; `confidence_is_calibrated` fits it.
const SLOPE: f32 = 33.5;

impl Learner for FaceRecognition {
    const SPEC: Spec = Spec::new("face_recognition", Task::FaceRecognition)
        .class("FaceRecognitionLearner")
        .about("MobileFace tells whose faces a frame shows, after a few reference pictures of each person.")
        .without_effect(&[
            ("backbone", "the model says it: MobileFace, or MobileNet where it was trained here"),
            ("network_head", "the network is trained by ArcFace's loss"),
            ("loss", "the network is trained by ArcFace's loss"),
            ("input_size", "the network says what it takes"),
            ("rgb_mean", "the network says what it takes"),
            ("rgb_std", "the network says what it takes"),
            ("drop_last", "the last batch counts"),
            ("stages", "`lr_steps` says them"),
            ("pin_memory", "there is nothing to pin"),
        ]);
    type Params = FaceRecognitionParams;
    type Input<'a> = &'a Image;
    type Target = BoundingBoxList;
    type State = ();

    fn load(model: &Model, params: FaceRecognitionParams, device: Device) -> Result<Self> {
        let network = PictureNetwork::open(model, device, |input| {
            let layout = if input.dims.last() == Some(&Some(3)) { Layout::Hwc } else { Layout::Chw };
            Preprocess::new(SIDE, SIDE).layout(layout)
        })?;
        let [output] = network.outputs() else {
            return Err(Error::format("the network of a face recogniser has one output, the embedding"));
        };
        let Some(dimension) = output.dims.last().copied().flatten().filter(|dimension| *dimension > 0) else {
            return Err(Error::format("the embedding of a face recogniser has a fixed length"));
        };
        let gallery = Gallery::of_model(model, dimension)?;
        Ok(Self {
            finder: FaceFinder::open(model, params.face_threshold, device)?,
            persons: gallery.names(),
            unknown: Name::Label(Arc::from("unknown")),
            scratch: Pool::default(),
            network,
            gallery,
            params,
        })
    }

    fn params(&self) -> &FaceRecognitionParams {
        &self.params
    }

    fn params_mut(&mut self) -> &mut FaceRecognitionParams {
        &mut self.params
    }

    fn classes(&self) -> Classes {
        self.persons.clone()
    }

    fn infer_into(&self, _: &mut (), image: &Image, answer: &mut BoundingBoxList) -> Result<()> {
        let Scratch { faces, embedding } = &mut *self.scratch.take();
        self.faces(image, faces)?;
        answer.classes.clone_from(&self.persons);
        answer.boxes.clear();
        for mut face in faces.boxes.drain(..) {
            if self.embed(image, &face, embedding)? {
                self.name(&mut face, embedding);
                answer.boxes.push(face);
            }
        }
        Ok(())
    }
}

impl FaceRecognition {
    /// The 256 numbers of each face in `image`, best first, scaled to length 1: the cosine of two is the sum of their
    /// products.
    ///
    /// # Errors
    /// As `infer`.
    pub fn embeddings(&self, image: &Image) -> Result<Vec<Vec<f32>>> {
        let Scratch { faces, embedding } = &mut *self.scratch.take();
        self.faces(image, faces)?;
        let mut all = Vec::new();
        for face in &faces.boxes {
            if self.embed(image, face, embedding)? {
                all.push(embedding.clone());
            }
        }
        Ok(all)
    }

    fn faces(&self, image: &Image, faces: &mut BoundingBoxList) -> Result<()> {
        if self.params.picture == FaceInput::Frame {
            return self.finder.find(image, faces);
        }
        faces.boxes.clear();
        faces.boxes.push(BoundingBox::new(0, 0.0, 0.0, image.width() as f32, image.height() as f32, 1.0));
        Ok(())
    }

    /// The face upright, as the network wants it; `None` where it has no extent.
    fn crop(&self, image: &Image, face: &BoundingBox) -> Option<Similarity> {
        match self.params.picture {
            FaceInput::Frame => Similarity::from_points(&face.landmarks, &TEMPLATE),
            FaceInput::Face => Some(whole_picture(image, SIDE)),
        }
    }

    /// Fills `embedding` with what the network gives for a face, length 1; `false` for a face without extent.
    fn embed(&self, image: &Image, face: &BoundingBox, embedding: &mut Vec<f32>) -> Result<bool> {
        let Some(crop) = self.crop(image, face) else { return Ok(false) };
        self.network.run_warped(
            image,
            &crop,
            |_| {},
            |outputs| {
                embedding.clear();
                embedding.extend_from_slice(outputs[0].values::<f32>()?);
                Ok(())
            },
        )?;
        Ok(normalise(embedding))
    }

    fn name(&self, face: &mut BoundingBox, embedding: &[f32]) {
        let (person, cosine) = self.gallery.nearest(embedding);
        let known = 1.0 / (1.0 + (-SLOPE * (cosine - self.params.threshold)).exp());
        let is_known = !self.persons.is_empty() && cosine >= self.params.threshold;
        face.name = if is_known { Name::Index(person as i64) } else { self.unknown.clone() };
        face.confidence = if is_known { known } else { 1.0 - known };
    }
}
