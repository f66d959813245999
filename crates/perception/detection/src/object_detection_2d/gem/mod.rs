//! GEM: a detector for a colour and an infrared camera with gated fusion.
//!
//! O. Mazhar, J. Kober, R. Babuska, GEM: Glare or Gloom, I Can Still See You. End-to-End Multimodal Object Detection, IEEE
//! Robotics and Automation Letters 2021. Each sensor has a backbone; gates compute the sensors' weights from the features
//! of both, and the detector continues with the weighted sum. In training sensors fail at random, so that either may fail
//! later, and a loss that the paper does not have gives the weight to the other sensor then. The fusion is GEM's; the
//! detector is our [SSD](super::single_shot_detector), where the paper has DETR, so its precision is an SSD's.

#[cfg(feature = "training")]
mod drop_sensor;
#[cfg(feature = "training")]
mod fit;
#[cfg(feature = "training")]
mod network;
#[cfg(feature = "training")]
mod objective;
#[cfg(test)]
#[cfg(feature = "training")]
mod tests;

#[cfg(feature = "training")]
pub use fit::GemFitParams;
use opendr_engine::data::Image;
use opendr_engine::learner::{Inputs, Learner, Spec, Targets};
use opendr_engine::model::Model;
use opendr_engine::params::Params;
use opendr_engine::target::{BoundingBoxList, Category, Classes};
use opendr_engine::{Device, Error, Pool, Result, Task};
use opendr_inference::{Session, TensorView};
use opendr_perception_common::boxes_from_candidates::boxes_from_candidates;
use opendr_perception_common::category_scores::category_from_probabilities;
use opendr_perception_common::suppression::{Candidate, Suppression, SuppressionKind, keep_best};
use opendr_vision::Preprocess;

use super::single_shot_detector::{Layout, Levels};

/// Parameters of [`Gem`].
#[derive(Debug, Clone, Params)]
pub struct GemParams {
    /// Score below which detections are dropped. OpenDR's default of 0.7 is for the scores of DETR.
    #[param(default = 0.3, range = 0.0..=1.0, live)]
    pub threshold: f32,
    /// IoU above which boxes of one class count as one object.
    #[param(default = 0.45, range = 0.0..=1.0, live)]
    pub iou_threshold: f32,
    /// Maximum number of boxes per pair of images.
    #[param(default = 100, range = 1..=1000, live)]
    pub max_detections: usize,
}

/// One view by two sensors.
#[derive(Debug, Clone, Copy, Inputs)]
pub struct GemInputs<'a> {
    /// Colour image. Boxes are in its pixels.
    pub colour: &'a Image,
    /// Image of the infrared sensor (or of another, as in training) with the same view. Its size may differ; points
    /// correspond by their relative positions.
    pub infrared: &'a Image,
}

/// Predictions for a pair of images.
#[derive(Debug, Clone, Default, PartialEq, Targets)]
pub struct GemTargets {
    /// Detections, in pixels of the colour image.
    pub boxes: BoundingBoxList,
    /// Weights of the sensors, of sum one: class 0 is colour, 1 infrared (OpenDR's `weight1` and `weight2`).
    pub sensors: Category,
}

/// A loaded GEM network.
pub struct Gem {
    params: GemParams,
    classes: Classes,
    sensors: Classes,
    session: Session,
    preprocess: Preprocess,
    levels: Levels,
    weights: usize,
    scratch: Pool<Scratch>,
}

#[derive(Default)]
struct Scratch {
    colour: Vec<f32>,
    infrared: Vec<f32>,
    candidates: Vec<Candidate>,
    marks: Vec<bool>,
}

/// File name of the network in a container. Inputs: `colour` and `infrared`, both `[1, 3, height, width]`. Outputs: those
/// of an SSD and [`WEIGHTS`] `[1, 2]`.
const FILE: &str = "model.onnx";
/// Name of the output with the weights of the sensors.
const WEIGHTS: &str = "weights";
/// Number of candidates with the highest scores that enter the suppression.
const MOST_CANDIDATES: usize = 400;

impl Learner for Gem {
    const SPEC: Spec = Spec::new("gem", Task::ObjectDetection2d)
        .class("GemLearner")
        .about(
            "Detects objects in a colour and an infrared image and predicts the weight of each sensor; trainable.",
        )
        .without_effect(&[
            ("model_config_path", "the parameters of fit describe the model"),
            ("dataset_config_path", "the data set describes itself"),
            ("num_classes", "it is the number of classes of the data set"),
            ("panoptic_segmentation", "it predicts boxes only"),
            ("temp_path", "fit writes to its output folder"),
            ("checkpoint_load_iter", "fit resumes from the last checkpoint of its output folder"),
        ]);
    type Params = GemParams;
    type Input<'a> = GemInputs<'a>;
    type Target = GemTargets;
    type State = ();

    fn load(model: &Model, params: GemParams, device: Device) -> Result<Self> {
        let Layout { image, anchors } = Layout::from_manifest(model.manifest())?;
        let classes = model.classes().clone();
        if classes.is_empty() {
            return Err(Error::format("the model names no classes; train or download it again"));
        }
        let session = Session::open(&model.file(FILE)?, device)?;
        let names: Vec<_> = session.inputs().iter().map(|input| input.name.as_str()).collect();
        if names != ["colour", "infrared"] {
            return Err(Error::format(format!(
                "{FILE} has the inputs {names:?} instead of colour and infrared; train or download it again"
            )));
        }
        let levels = Levels::open(anchors, image.size(), |name| session.output_index(name))?;
        let weights = session.output_index(WEIGHTS)?;
        let sensors = names.into_iter().collect();
        let (preprocess, scratch) = (image.preprocess(), Pool::default());
        Ok(Self { params, classes, sensors, session, preprocess, levels, weights, scratch })
    }

    fn params(&self) -> &GemParams {
        &self.params
    }

    fn params_mut(&mut self) -> &mut GemParams {
        &mut self.params
    }

    fn classes(&self) -> Classes {
        self.classes.clone()
    }

    fn infer_into(&self, _: &mut (), input: GemInputs<'_>, target: &mut GemTargets) -> Result<()> {
        let Scratch { colour, infrared, candidates, marks } = &mut *self.scratch.take();
        colour.resize(self.preprocess.len(), 0.0);
        infrared.resize(self.preprocess.len(), 0.0);
        let geometry = self.preprocess.run_into(input.colour.view(), &mut colour[..])?;
        self.preprocess.run_into(input.infrared.view(), &mut infrared[..])?;
        let shape = self.preprocess.shape();
        let tensors = [TensorView::new(&shape, &colour[..])?, TensorView::new(&shape, &infrared[..])?];
        candidates.clear();
        self.session.run(&tensors, |outputs| {
            let GemParams { threshold, iou_threshold, max_detections } = self.params;
            self.levels.decode(outputs, self.classes.len(), threshold, candidates)?;
            keep_best(candidates, MOST_CANDIDATES);
            let kind = SuppressionKind::Hard;
            let suppression = Suppression { kind, iou_threshold, threshold, max_boxes: max_detections };
            suppression.run(candidates, marks);
            boxes_from_candidates(&mut target.boxes, candidates, &geometry, &self.classes);
            let weights = outputs[self.weights].values::<f32>()?;
            category_from_probabilities(&mut target.sensors, weights.iter().copied(), &self.sensors)
        })
    }
}
