//! Face recognition: faces are detected, aligned by five points, and compared with those of known persons.
//!
//! MobileFace computes an embedding of 256 values per face (trained with ArcFace's loss: Deng et al., CVPR 2019); the
//! cosine of two embeddings decides whether they are of one person. `fit` stores images of each person as references and
//! trains the network only on request. The set of persons is open: a face that is close to none is unknown.

#[cfg(feature = "training")]
mod fit;
mod gallery;
#[cfg(feature = "training")]
mod network;
#[cfg(feature = "training")]
mod objective;

use std::sync::Arc;

use opendr_engine::data::Image;
use opendr_engine::learner::{Learner, Spec};
use opendr_engine::model::Model;
use opendr_engine::params::Params;
use opendr_engine::target::{BoundingBox, BoundingBoxList, Classes, Name};
use opendr_engine::{Device, Error, Pool, Result, Task};
use opendr_face_detection::face_detector::{FaceDetector, FaceInput, whole_image};
use opendr_perception_common::embedding_network::{EmbeddingInputParams, EmbeddingNetwork};
use opendr_vision::Similarity;

use gallery::Gallery;

#[cfg(feature = "training")]
pub use fit::{FaceRecognitionFitParams, FaceRecognitionMode};

/// Parameters of [`FaceRecognition`].
#[derive(Debug, Clone, Params)]
pub struct FaceRecognitionParams {
    /// Cosine to every image of a known person below which a face is unknown.
    #[param(default = 0.38, range = -1.0..=1.0, live)]
    pub threshold: f32,
    /// Score of the detector below which faces are dropped.
    #[param(default = 0.6, range = 0.0..=1.0)]
    pub face_threshold: f32,
    /// Content of the images.
    #[param(live, former = "picture")]
    pub input_kind: FaceInput,
    /// Input of the network of embeddings.
    #[param(flatten)]
    pub input: EmbeddingInputParams,
}

/// A loaded face recogniser.
///
/// Its predictions are a box for every face, highest score first, with the person's class or the label `unknown`. The
/// confidence of a box is the probability of its class, 0.5..=1, a logistic function of the cosine centred at the
/// threshold. Its slope is the maximum likelihood estimate on 300 labelled pairs of faces (deepface's test set; Brier score
/// 0.017).
pub struct FaceRecognition {
    params: FaceRecognitionParams,
    finder: FaceDetector,
    network: EmbeddingNetwork,
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

/// Side of the input of MobileFace and of the network that `fit` trains, in pixels.
const SIDE: usize = 112;
/// ArcFace's positions of eyes, nose and corners of the mouth in an input of that side (insightface's `arcface_dst`).
const TEMPLATE: [[f32; 2]; 5] =
    [[38.2946, 51.6963], [73.5318, 51.5014], [56.0252, 71.7366], [41.5493, 92.3655], [70.7299, 92.2041]];
/// Slope of the confidence as a function of the cosine; `confidence_is_calibrated` fits it.
const SLOPE: f32 = 33.5;

impl Learner for FaceRecognition {
    const SPEC: Spec = Spec::new("face_recognition", Task::FaceRecognition)
        .class("FaceRecognitionLearner")
        .about("MobileFace recognises the persons in an image by their faces, from a few reference images of each.")
        .without_effect(&[
            ("backbone", "the model determines it: MobileFace, or MobileNet after fit"),
            ("network_head", "the network is trained by ArcFace's loss"),
            ("loss", "the network is trained by ArcFace's loss"),
            ("input_size", "the model defines it"),
            ("rgb_mean", "the model defines it"),
            ("rgb_std", "the model defines it"),
            ("drop_last", "the last batch is always used"),
            ("stages", "`lr_steps` sets them"),
            ("pin_memory", "memory is not pinned"),
        ]);
    type Params = FaceRecognitionParams;
    type Input<'a> = &'a Image;
    type Target = BoundingBoxList;
    type State = ();

    fn load(model: &Model, params: FaceRecognitionParams, device: Device) -> Result<Self> {
        let network = EmbeddingNetwork::open(model, &params.input, device)?;
        let [width, height] = network.size();
        if width != height {
            return Err(Error::format(format!(
                "the network's input has {width} x {height} pixels; faces are aligned to a square; load another model"
            )));
        }
        let gallery = Gallery::of_model(model, network.length())?;
        Ok(Self {
            finder: FaceDetector::open(model, params.face_threshold, device)?,
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

    fn infer_into(&self, _: &mut (), image: &Image, boxes: &mut BoundingBoxList) -> Result<()> {
        let Scratch { faces, embedding } = &mut *self.scratch.take();
        self.faces(image, faces)?;
        boxes.classes.clone_from(&self.persons);
        boxes.boxes.clear();
        for mut face in faces.boxes.drain(..) {
            if self.embed(image, &face, embedding)? {
                self.name(&mut face, embedding);
                boxes.boxes.push(face);
            }
        }
        Ok(())
    }
}

impl FaceRecognition {
    /// Returns the embedding of each face in `image`, highest score first, scaled to length 1: the cosine of two is their
    /// dot product.
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
        if self.params.input_kind == FaceInput::Frame {
            return self.finder.detect(image, faces);
        }
        faces.boxes.clear();
        faces.boxes.push(BoundingBox::new(0, 0.0, 0.0, image.width() as f32, image.height() as f32, 1.0));
        Ok(())
    }

    /// Returns the crop of the aligned face of `side` pixels; `None` when it has no extent.
    fn crop(&self, image: &Image, face: &BoundingBox, side: usize) -> Option<Similarity> {
        match self.params.input_kind {
            FaceInput::Frame => {
                let template = TEMPLATE.map(|point| point.map(|value| value * side as f32 / SIDE as f32));
                Similarity::from_points(&face.landmarks, &template)
            }
            FaceInput::Face => Some(whole_image(image, side)),
        }
    }

    /// Fills `embedding` with a face's embedding of length 1; returns `false` for a face without extent.
    fn embed(&self, image: &Image, face: &BoundingBox, embedding: &mut Vec<f32>) -> Result<bool> {
        let [side, _] = self.network.size();
        let Some(crop) = self.crop(image, face, side) else { return Ok(false) };
        self.network.embed_crop(image, &crop, embedding)
    }

    fn name(&self, face: &mut BoundingBox, embedding: &[f32]) {
        let (person, cosine) = self.gallery.nearest(embedding);
        let known = 1.0 / (1.0 + (-SLOPE * (cosine - self.params.threshold)).exp());
        let is_known = !self.persons.is_empty() && cosine >= self.params.threshold;
        face.name = if is_known { Name::Index(person as i64) } else { self.unknown.clone() };
        face.confidence = if is_known { known } else { 1.0 - known };
    }
}
