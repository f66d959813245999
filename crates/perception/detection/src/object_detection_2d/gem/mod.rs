//! GEM: a detector of two sensors that tells which of them to trust.
//!
//! O. Mazhar, J. Kober, R. Babuska, GEM: Glare or Gloom, I Can Still See You. End-to-End Multimodal Object Detection, IEEE
//! Robotics and Automation Letters 2021. A backbone sees each sensor; gates weigh their features by what both see, and their
//! sum goes on. In training sensors fail at random, so that either may fail later, and a loss that GEM has not asks the gates to
//! trust the other one then. That fusion is GEM's; the detector behind
//! it is our [SSD](super::single_shot_detector), where GEM has DETR: what it finds, and how surely, is an SSD's.

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

/// What a user may set.
#[derive(Debug, Clone, Params)]
pub struct GemParams {
    /// Detections below this score are dropped. OpenDR's default of 0.7 is for the scores of DETR.
    #[param(default = 0.3, range = 0.0..=1.0, live)]
    pub threshold: f32,
    /// Boxes of one class that overlap more than this (intersection over union) are one object.
    #[param(default = 0.45, range = 0.0..=1.0, live)]
    pub iou_threshold: f32,
    /// At most this many boxes a pair of pictures.
    #[param(default = 100, range = 1..=1000, live)]
    pub max_detections: usize,
}

/// One view by two sensors.
#[derive(Debug, Clone, Copy, Inputs)]
pub struct GemInputs<'a> {
    /// The picture in colour. Boxes are in its pixels.
    pub colour: &'a Image,
    /// The picture of the infrared sensor (or of another, as in training), of the same view: sizes may differ, what it shows
    /// at a share of its width and height may not.
    pub infrared: &'a Image,
}

/// What is told of a pair of pictures.
#[derive(Debug, Clone, Default, PartialEq, Targets)]
pub struct GemTargets {
    /// The objects, in pixels of the picture in colour.
    pub boxes: BoundingBoxList,
    /// How much each sensor counted, of sum one: class 0 is colour, 1 infrared (OpenDR's `weight1` and `weight2`).
    pub sensors: Category,
}

/// A loaded network.
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

/// The network in every container: `colour` and `infrared`, both `[1, 3, height, width]`, to the outputs of an SSD and
/// [`WEIGHTS`] `[1, 2]`.
const FILE: &str = "model.onnx";
/// The output that says how much each sensor counted.
const WEIGHTS: &str = "weights";
/// So many of the best boxes are looked at.
const MOST_CANDIDATES: usize = 400;

impl Learner for Gem {
    const SPEC: Spec = Spec::new("gem", Task::ObjectDetection2d)
        .class("GemLearner")
        .about(
            "Finds objects by a colour and an infrared camera and tells which of them to trust; it trains.",
        )
        .without_effect(&[
            ("model_config_path", "what the model is made of are parameters of fit"),
            ("dataset_config_path", "the data set says it itself"),
            ("num_classes", "the classes of the data set are trained"),
            ("panoptic_segmentation", "it finds boxes alone"),
            ("temp_path", "what fit writes lies in its output folder"),
            ("checkpoint_load_iter", "fit goes on from the last checkpoint of its output folder"),
        ]);
    type Params = GemParams;
    type Input<'a> = GemInputs<'a>;
    type Target = GemTargets;
    type State = ();

    fn load(model: &Model, params: GemParams, device: Device) -> Result<Self> {
        let Layout { image, anchors } = Layout::from_manifest(model.manifest())?;
        let classes = model.classes().clone();
        if classes.is_empty() {
            return Err(Error::format("the model names no classes; train or get it anew"));
        }
        let session = Session::open(&model.file(FILE)?, device)?;
        let names: Vec<_> = session.inputs().iter().map(|input| input.name.as_str()).collect();
        if names != ["colour", "infrared"] {
            return Err(Error::format(format!("{FILE} takes {names:?}, not colour and infrared")));
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
            let suppression = Suppression { kind, overlap: iou_threshold, threshold, most: max_detections };
            suppression.run(candidates, marks);
            boxes_from_candidates(&mut target.boxes, candidates, &geometry, &self.classes);
            let weights = outputs[self.weights].values::<f32>()?;
            category_from_probabilities(&mut target.sensors, weights.iter().copied(), &self.sensors)
        })
    }
}
