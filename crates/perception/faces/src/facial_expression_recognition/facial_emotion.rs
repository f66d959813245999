//! Facial emotion: one of seven emotions of the largest face in an image.
//!
//! mini-XCEPTION (Arriaga et al., Real-time Convolutional Neural Networks for Emotion and Gender Classification, 2017),
//! trained on FER2013: angry, disgust, fear, happy, sad, surprise, neutral. It does not predict valence and arousal.

use opendr_engine::data::{Image, Layout};
use opendr_engine::learner::{Learner, Spec};
use opendr_engine::model::Model;
use opendr_engine::params::Params;
use opendr_engine::target::{BoundingBoxList, Category, Classes};
use opendr_engine::{Device, Pool, Result, Task};
use opendr_face_detection::face_detector::{
    FaceDetector, FaceInput, largest_face, square_around, whole_image,
};
use opendr_perception_common::category_scores::category_from_scores;
use opendr_perception_common::image_network::ImageNetwork;
use opendr_vision::{Border, ChannelOrder, Preprocess};

/// Parameters of [`FacialEmotion`].
#[derive(Debug, Clone, Params)]
pub struct FacialEmotionParams {
    /// Score of the detector below which faces are dropped.
    #[param(default = 0.6, range = 0.0..=1.0)]
    pub face_threshold: f32,
    /// Content of the images.
    #[param(live, former = "picture")]
    pub input_kind: FaceInput,
}

/// A loaded network with its face detector.
///
/// Of several faces the largest counts. Without a face the prediction is class -1, `no face`, with confidence 0 and no
/// probabilities.
pub struct FacialEmotion {
    params: FacialEmotionParams,
    classes: Classes,
    finder: FaceDetector,
    network: ImageNetwork,
    no_face: Classes,
    scratch: Pool<BoundingBoxList>,
}

/// Side of the network's input, in pixels.
const SIDE: usize = 64;
/// Side of the crop in longer sides of the face's box.
const SCALE: f32 = 1.2;

impl Learner for FacialEmotion {
    const SPEC: Spec = Spec::new("facial_emotion", Task::FacialExpressionRecognition)
        .class("FacialEmotionLearner")
        .about("mini-XCEPTION classifies the emotion of the largest face in an image, one of seven.")
        .without_effect(&[
            ("device_ind", "`device` sets it"),
            ("validation_interval", Spec::TRAINING_ONLY),
            ("max_training_epoch", Spec::TRAINING_ONLY),
            ("momentum", Spec::TRAINING_ONLY),
            ("ensemble_size", "the network is one, not an ensemble"),
            ("base_path_experiment", Spec::TRAINING_ONLY),
            ("name_experiment", Spec::TRAINING_ONLY),
            ("dimensional_finetune", Spec::TRAINING_ONLY),
            ("categorical_train", Spec::TRAINING_ONLY),
            ("base_path_to_dataset", Spec::TRAINING_ONLY),
            ("max_tuning_epoch", Spec::TRAINING_ONLY),
            ("diversify", Spec::TRAINING_ONLY),
        ]);
    type Params = FacialEmotionParams;
    type Input<'a> = &'a Image;
    type Target = Category;
    type State = ();

    fn load(model: &Model, params: FacialEmotionParams, device: Device) -> Result<Self> {
        let network = ImageNetwork::open(model, device, |input| {
            let layout = if input.dims.last() == Some(&Some(1)) { Layout::Hwc } else { Layout::Chw };
            let grey = Preprocess::new(SIDE, SIDE).order(ChannelOrder::Grey).layout(layout);
            grey.normalise([127.5; 3], [127.5; 3]).border(Border::Constant(0.0))
        })?;
        Ok(Self {
            finder: FaceDetector::open(model, params.face_threshold, device)?,
            classes: model.classes().clone(),
            no_face: ["no face"].into_iter().collect(),
            scratch: Pool::default(),
            network,
            params,
        })
    }

    fn params(&self) -> &FacialEmotionParams {
        &self.params
    }

    fn params_mut(&mut self) -> &mut FacialEmotionParams {
        &mut self.params
    }

    fn classes(&self) -> Classes {
        self.classes.clone()
    }

    fn infer_into(&self, _: &mut (), image: &Image, category: &mut Category) -> Result<()> {
        let faces = &mut *self.scratch.take();
        let crop = match self.params.input_kind {
            FaceInput::Face => Some(whole_image(image, SIDE)),
            FaceInput::Frame => {
                self.finder.detect(image, faces)?;
                largest_face(faces).map(|face| square_around(face, SCALE, 0.0, SIDE))
            }
        };
        let Some(crop) = crop else {
            category.class = -1;
            category.description = self.no_face.name(0).cloned();
            category.confidence = Some(0.0);
            category.probabilities.clear();
            return Ok(());
        };
        self.network.run_warped(
            image,
            &crop,
            |_| {},
            |outputs| {
                let scores = outputs[0].values::<f32>()?;
                category_from_scores(category, scores.iter().copied(), &self.classes)
            },
        )
    }
}
