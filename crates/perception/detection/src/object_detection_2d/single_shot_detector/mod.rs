//! SSD: boxes and class labels from anchors on feature maps of several scales, in one pass.
//!
//! Liu et al., SSD: Single Shot MultiBox Detector, ECCV 2016; on MobileNetV1 with separable heads (SSDLite, Sandler et al.,
//! CVPR 2018). Suited to training on own classes and to small weights; [`super::CenterNet`] and [`super::Nanodet`] are more
//! precise on the 80 COCO classes.

pub mod anchors;
pub mod coding;
pub mod decode;
#[cfg(feature = "training")]
mod fit;
mod layout;
#[cfg(feature = "training")]
mod layout_params;
mod levels;
#[cfg(feature = "training")]
pub(crate) mod loss;
pub mod matching;
#[cfg(feature = "training")]
pub(crate) mod network;
#[cfg(feature = "training")]
mod objective;
#[cfg(feature = "training")]
pub(crate) mod targets;
#[cfg(test)]
#[cfg(feature = "training")]
mod tests;

use opendr_engine::data::Image;
use opendr_engine::learner::{Learner, Spec};
use opendr_engine::model::Model;
use opendr_engine::params::Params;
use opendr_engine::target::{BoundingBoxList, Classes};
use opendr_engine::{Device, Error, Pool, Result, Task};
use opendr_perception_common::boxes_from_candidates::boxes_from_candidates;
use opendr_perception_common::image_network::ImageNetwork;
use opendr_perception_common::suppression::{Candidate, Suppression, SuppressionKind, keep_best};

#[cfg(feature = "training")]
pub use fit::{Backbone, SingleShotDetectorFitParams};
pub use layout::{ImageLayout, Layout, Resizing};
#[cfg(feature = "training")]
pub use layout_params::LayoutParams;
pub(crate) use levels::Levels;
#[cfg(feature = "training")]
pub(crate) use levels::output_names;
#[cfg(feature = "training")]
pub use objective::DetectionObjective;

/// Parameters of [`SingleShotDetector`].
#[derive(Debug, Clone, Params)]
pub struct SingleShotDetectorParams {
    /// Score below which detections are dropped.
    #[param(default = 0.2, range = 0.0..=1.0, live)]
    pub threshold: f32,
    /// IoU above which boxes of one class count as one object.
    #[param(default = 0.45, range = 0.0..=1.0, live, alias = "nms_thresh")]
    pub iou_threshold: f32,
    /// Number of candidates with the highest scores that enter the suppression.
    #[param(default = 400, range = 1..=1000, live, alias = "nms_topk")]
    pub max_candidates: usize,
    /// Maximum number of boxes per image.
    #[param(default = 100, range = 1..=1000, live, alias = "post_nms")]
    pub max_detections: usize,
    /// Method of non-maximum suppression.
    #[param(live, alias = "custom_nms")]
    pub suppression: SuppressionKind,
}

/// A loaded single-shot detector.
pub struct SingleShotDetector {
    params: SingleShotDetectorParams,
    classes: Classes,
    network: ImageNetwork,
    levels: Levels,
    scratch: Pool<Scratch>,
}

#[derive(Default)]
struct Scratch {
    candidates: Vec<Candidate>,
    marks: Vec<bool>,
}

impl Learner for SingleShotDetector {
    const SPEC: Spec = Spec::new("single_shot_detector", Task::ObjectDetection2d)
        .class("SingleShotDetectorLearner")
        .about("SSD on MobileNetV1, a small detector, trainable on own classes.")
        .without_effect(&[
            ("keep_size", "the network's input has a fixed size"),
            ("extract_maps", "feature maps are not an output"),
            ("temp_path", "fit writes to its output folder"),
            ("checkpoint_load_iter", "fit resumes from the last checkpoint of its output folder"),
        ]);
    type Params = SingleShotDetectorParams;
    type Input<'a> = &'a Image;
    type Target = BoundingBoxList;
    type State = ();

    fn load(model: &Model, params: SingleShotDetectorParams, device: Device) -> Result<Self> {
        let Layout { image, anchors } = Layout::from_manifest(model.manifest())?;
        let classes = model.manifest().classes.clone();
        if classes.is_empty() {
            return Err(Error::format("the model names no classes; train or download it again"));
        }
        let network = ImageNetwork::open(model, device, |_| image.preprocess())?;
        let levels = Levels::open(anchors, image.size(), |name| network.output(name))?;
        Ok(Self { params, classes, network, levels, scratch: Pool::default() })
    }

    fn params(&self) -> &SingleShotDetectorParams {
        &self.params
    }

    fn params_mut(&mut self) -> &mut SingleShotDetectorParams {
        &mut self.params
    }

    fn classes(&self) -> Classes {
        self.classes.clone()
    }

    fn infer_into(&self, _: &mut (), image: &Image, boxes: &mut BoundingBoxList) -> Result<()> {
        let Scratch { candidates, marks } = &mut *self.scratch.take();
        candidates.clear();
        self.network.run(image, |outputs, geometry| {
            self.levels.decode(outputs, self.classes.len(), self.params.threshold, candidates)?;
            keep_best(candidates, self.params.max_candidates);
            self.suppression().run(candidates, marks);
            boxes_from_candidates(boxes, candidates, geometry, &self.classes);
            Ok(())
        })
    }
}

impl SingleShotDetector {
    fn suppression(&self) -> Suppression {
        let SingleShotDetectorParams { threshold, iou_threshold, max_detections, suppression, .. } =
            self.params;
        Suppression { kind: suppression, iou_threshold, threshold, max_boxes: max_detections }
    }
}
