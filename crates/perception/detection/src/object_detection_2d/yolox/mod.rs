//! YOLOX: an anchor-free one-stage detector, trainable on own classes.
//!
//! Ge et al., YOLOX: Exceeding YOLO Series in 2021, arXiv 2107.08430; code and weights Apache-2.0. The variant `nano` is the most
//! precise of the light detectors and has the smallest file.

use opendr_engine::data::Image;
use opendr_engine::learner::{Learner, Spec};
use opendr_engine::model::Model;
use opendr_engine::params::Params;
use opendr_engine::target::{BoundingBoxList, Classes};
use opendr_engine::{Device, Pool, Result, Task};
use opendr_inference::TensorInfo;
use opendr_perception_common::boxes_from_candidates::boxes_from_candidates;
use opendr_perception_common::exported_network::{Rows, Selection, decode_grid};
use opendr_perception_common::image_network::{ImageNetwork, preprocess_from_input};
use opendr_perception_common::suppression::{Candidate, Suppression, SuppressionKind};
use opendr_vision::{ChannelOrder, LetterboxAlign, Preprocess};

#[cfg(feature = "training")]
mod assignment;
#[cfg(feature = "training")]
mod batch;
#[cfg(feature = "training")]
mod fit;
#[cfg(feature = "training")]
mod network;
#[cfg(feature = "training")]
mod objective;

#[cfg(feature = "training")]
pub use fit::YoloxFitParams;
#[cfg(feature = "training")]
pub use network::{YoloxNetwork, YoloxSize};

/// Parameters of [`Yolox`].
#[derive(Debug, Clone, Params)]
pub struct YoloxParams {
    /// Score below which detections are dropped.
    #[param(default = 0.3, range = 0.0..=1.0, live)]
    pub threshold: f32,
    /// IoU above which boxes of one class count as one object.
    #[param(default = 0.45, range = 0.0..=1.0, live)]
    pub iou_threshold: f32,
    /// Maximum number of boxes per image.
    #[param(default = 100, range = 1..=1000, live)]
    pub max_detections: usize,
    /// Whether a cell may be a detection of several classes, or of that with the highest score only.
    #[param(default = true, live)]
    pub multi_label: bool,
    /// Method of non-maximum suppression.
    #[param(live)]
    pub suppression: SuppressionKind,
}

/// A loaded YOLOX.
pub struct Yolox {
    params: YoloxParams,
    classes: Classes,
    network: ImageNetwork,
    scratch: Pool<Scratch>,
}

#[derive(Default)]
struct Scratch {
    best: Vec<(f32, u32)>,
    candidates: Vec<Candidate>,
    marks: Vec<bool>,
}

/// Strides of the levels, in pixels.
const STRIDES: [usize; 3] = [8, 16, 32];
/// Level of the padding.
const PADDING: f32 = 114.0;
/// File of the network in a container.
const FILE: &str = "model.onnx";
/// Side of the input of a network that trains from random weights, in pixels.
#[cfg(feature = "training")]
const SIDE: usize = 416;

/// Returns the pre-processing for the network's `input`.
fn preprocess(input: &TensorInfo) -> Result<Preprocess> {
    preprocess_from_input(input).map(for_yolox)
}

/// Adds padding and order of the colours.
fn for_yolox(preprocess: Preprocess) -> Preprocess {
    preprocess.letterbox(LetterboxAlign::TopLeftTruncated, PADDING).order(ChannelOrder::Bgr)
}

impl Learner for Yolox {
    const SPEC: Spec = Spec::new("yolox", Task::ObjectDetection2d)
        .class("YoloxLearner")
        .about("YOLOX, an anchor-free detector; the most precise light detector of the 80 COCO classes, trainable on own ones.");
    type Params = YoloxParams;
    type Input<'a> = &'a Image;
    type Target = BoundingBoxList;
    type State = ();

    fn load(model: &Model, params: YoloxParams, device: Device) -> Result<Self> {
        let network = ImageNetwork::open_file(model, FILE, device, preprocess)?;
        Ok(Self { params, classes: model.classes().clone(), network, scratch: Pool::default() })
    }

    fn params(&self) -> &YoloxParams {
        &self.params
    }

    fn params_mut(&mut self) -> &mut YoloxParams {
        &mut self.params
    }

    fn classes(&self) -> Classes {
        self.classes.clone()
    }

    fn infer_into(&self, _: &mut (), image: &Image, boxes: &mut BoundingBoxList) -> Result<()> {
        let Scratch { best, candidates, marks } = &mut *self.scratch.take();
        let YoloxParams { threshold, iou_threshold, max_detections, multi_label, suppression } = self.params;
        let suppression =
            Suppression { kind: suppression, iou_threshold, threshold, max_boxes: max_detections };
        let selection = Selection { threshold, multi_label };
        candidates.clear();
        self.network.run(image, |outputs, geometry| {
            let rows = Rows::of(&outputs[0], false)?;
            decode_grid(&rows, self.network.size(), &STRIDES, selection, best, candidates)?;
            suppression.run(candidates, marks);
            boxes_from_candidates(boxes, candidates, geometry, &self.classes);
            Ok(())
        })
    }
}
