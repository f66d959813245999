//! Ultra-Light-Fast-Generic-Face-Detector (RFB, 320x240): faces in a few milliseconds on any CPU.
//!
//! Linzaer, MIT. An SSD with four levels; the model contains its decoder, whose boxes are between 0 and 1. It has no
//! landmarks; [`super::Yunet`] does.

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

/// Parameters of [`UltraLightFace`].
#[derive(Debug, Clone, Params)]
pub struct UltraLightFaceParams {
    /// Score below which faces are dropped.
    #[param(default = 0.7, range = 0.0..=1.0, live)]
    pub threshold: f32,
    /// IoU above which boxes count as one face.
    #[param(default = 0.3, range = 0.0..=1.0, live)]
    pub iou_threshold: f32,
    /// Maximum number of faces per image.
    #[param(default = 200, range = 1..=1000, live)]
    pub max_detections: usize,
    /// Method of non-maximum suppression.
    #[param(live)]
    pub suppression: SuppressionKind,
}

/// A loaded Ultra-Light face detector.
pub struct UltraLightFace {
    params: UltraLightFaceParams,
    classes: Classes,
    network: ImageNetwork,
    scores: usize,
    boxes: usize,
    scratch: Pool<Scratch>,
}

#[derive(Default)]
struct Scratch {
    candidates: Vec<Candidate>,
    marks: Vec<bool>,
}

const WIDTH: usize = 320;
const HEIGHT: usize = 240;

impl Learner for UltraLightFace {
    const SPEC: Spec = Spec::new("ultra_light_face", Task::FaceDetection)
        .class("UltraLightFaceLearner")
        .about("Ultra-Light RFB detects faces in a few milliseconds; boxes only.");
    type Params = UltraLightFaceParams;
    type Input<'a> = &'a Image;
    type Target = BoundingBoxList;
    type State = ();

    fn load(model: &Model, params: UltraLightFaceParams, device: Device) -> Result<Self> {
        let network = ImageNetwork::open(model, device, |_| {
            Preprocess::new(WIDTH, HEIGHT).normalise([127.0; 3], [128.0; 3])
        })?;
        Ok(Self {
            scores: network.output("scores")?,
            boxes: network.output("boxes")?,
            classes: model.manifest().classes.clone(),
            scratch: Pool::default(),
            network,
            params,
        })
    }

    fn params(&self) -> &UltraLightFaceParams {
        &self.params
    }

    fn params_mut(&mut self) -> &mut UltraLightFaceParams {
        &mut self.params
    }

    fn classes(&self) -> Classes {
        self.classes.clone()
    }

    fn infer_into(&self, _: &mut (), image: &Image, faces: &mut BoundingBoxList) -> Result<()> {
        let Scratch { candidates, marks } = &mut *self.scratch.take();
        let UltraLightFaceParams { threshold, iou_threshold, max_detections, suppression } = self.params;
        let suppression =
            Suppression { kind: suppression, iou_threshold, threshold, max_boxes: max_detections };
        candidates.clear();
        self.network.run(image, |outputs, geometry| {
            let (scores, boxes) =
                (outputs[self.scores].values::<f32>()?, outputs[self.boxes].values::<f32>()?);
            let rows = scores.chunks_exact(2).zip(boxes.chunks_exact(4)).zip(0..);
            let found = rows.filter(|((scores, _), _)| scores[1] >= threshold);
            candidates.extend(found.map(|((scores, edges), index)| Candidate {
                corners: [
                    edges[0] * WIDTH as f32,
                    edges[1] * HEIGHT as f32,
                    edges[2] * WIDTH as f32,
                    edges[3] * HEIGHT as f32,
                ],
                score: scores[1],
                class: 0,
                index,
            }));
            suppression.run(candidates, marks);
            boxes_from_candidates(faces, candidates, geometry, &self.classes);
            Ok(())
        })
    }
}
