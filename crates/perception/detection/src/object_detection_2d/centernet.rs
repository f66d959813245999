//! CenterNet on MobileNetV3: objects as peaks of a heatmap.
//!
//! Zhou et al., Objects as Points, 2019. The network contains its decoder: 100 boxes, highest score first. A light
//! suppression is still useful, as a large object may have two peaks.

use opendr_engine::data::Image;
use opendr_engine::learner::{Learner, Spec};
use opendr_engine::model::Model;
use opendr_engine::params::Params;
use opendr_engine::target::{BoundingBoxList, Classes};
use opendr_engine::{Device, Pool, Result, Task};
use opendr_perception_common::boxes_from_candidates::boxes_from_candidates;
use opendr_perception_common::image_network::ImageNetwork;
use opendr_perception_common::suppression::{Candidate, Suppression, SuppressionKind};
use opendr_vision::Preprocess;

/// Parameters of [`CenterNet`].
#[derive(Debug, Clone, Params)]
pub struct CenterNetParams {
    /// Score below which detections are dropped.
    #[param(default = 0.3, range = 0.0..=1.0, live)]
    pub threshold: f32,
    /// IoU above which boxes of one class count as one object.
    #[param(default = 0.5, range = 0.0..=1.0, live)]
    pub iou_threshold: f32,
    /// Maximum number of boxes per image.
    #[param(default = 100, range = 1..=100, live)]
    pub max_detections: usize,
    /// Method of non-maximum suppression.
    #[param(live)]
    pub suppression: SuppressionKind,
}

/// A loaded CenterNet.
pub struct CenterNet {
    params: CenterNetParams,
    classes: Classes,
    network: ImageNetwork,
    detections: usize,
    scratch: Pool<Scratch>,
}

#[derive(Default)]
struct Scratch {
    candidates: Vec<Candidate>,
    marks: Vec<bool>,
}

/// Side of the network's input, in pixels.
const SIDE: usize = 512;
/// Number of values of a detection: x0, y0, x1, y1, score, class.
const FIELDS: usize = 6;

impl Learner for CenterNet {
    const SPEC: Spec = Spec::new("centernet", Task::ObjectDetection2d)
        .class("CenterNetDetectorLearner")
        .about(
            "CenterNet on MobileNetV3 detects the 80 COCO classes; the most precise of the light detectors.",
        )
        .without_effect(&[
            ("img_size", "the network's input has a fixed size"),
            ("keep_size", "the whole image is resized to the network's input"),
            ("num_workers", Spec::TRAINING_ONLY),
            ("epochs", Spec::TRAINING_ONLY),
            ("val_after", Spec::TRAINING_ONLY),
            ("log_after", Spec::TRAINING_ONLY),
            ("weight_decay", Spec::TRAINING_ONLY),
            ("momentum", Spec::TRAINING_ONLY),
            ("wh_weight", Spec::TRAINING_ONLY),
            ("center_reg_weight", Spec::TRAINING_ONLY),
            ("lr_decay_epoch", Spec::TRAINING_ONLY),
            ("lr_decay", Spec::TRAINING_ONLY),
            ("warmup_epochs", Spec::TRAINING_ONLY),
            ("flip_validation", Spec::TRAINING_ONLY),
        ]);
    type Params = CenterNetParams;
    type Input<'a> = &'a Image;
    type Target = BoundingBoxList;
    type State = ();

    fn load(model: &Model, params: CenterNetParams, device: Device) -> Result<Self> {
        let network = ImageNetwork::open(model, device, |_| Preprocess::new(SIDE, SIDE))?;
        Ok(Self {
            detections: network.output("tower_0/detections")?,
            classes: model.manifest().classes.clone(),
            scratch: Pool::default(),
            network,
            params,
        })
    }

    fn params(&self) -> &CenterNetParams {
        &self.params
    }

    fn params_mut(&mut self) -> &mut CenterNetParams {
        &mut self.params
    }

    fn classes(&self) -> Classes {
        self.classes.clone()
    }

    fn infer_into(&self, _: &mut (), image: &Image, boxes: &mut BoundingBoxList) -> Result<()> {
        let Scratch { candidates, marks } = &mut *self.scratch.take();
        let CenterNetParams { threshold, iou_threshold, max_detections, suppression } = self.params;
        let suppression =
            Suppression { kind: suppression, iou_threshold, threshold, max_boxes: max_detections };
        candidates.clear();
        self.network.run(image, |outputs, geometry| {
            candidates.extend(outputs[self.detections].values()?.chunks_exact(FIELDS).zip(0..).map(
                |(row, index)| Candidate {
                    corners: [row[0], row[1], row[2], row[3]],
                    score: row[4],
                    class: row[5] as u32,
                    index,
                },
            ));
            suppression.run(candidates, marks);
            boxes_from_candidates(boxes, candidates, geometry, &self.classes);
            Ok(())
        })
    }
}
