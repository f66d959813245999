//! Pose estimator from an ONNX file that another tool exported: YOLOv8-pose, YOLO11-pose, YOLO26-pose, RTMO.
//!
//! The network detects boxes of persons or other objects with their keypoints in a whole image. Layout of inputs and outputs is recognised
//! from names, shapes and metadata. A parameter overrides it; what is neither recognised nor given is an error that names the parameter.

mod convention;
mod decode;
mod params;

use opendr_engine::data::Image;
use opendr_engine::learner::{Learner, Spec};
use opendr_engine::model::Model;
use opendr_engine::target::{Classes, PoseList};
use opendr_engine::{Device, Pool, Result, Task};
use opendr_perception_common::exported_network::{ExportedNetwork, Facts, ImageInput, NetworkKind};
use opendr_perception_common::suppression::Suppression;

pub use params::{ImportedPoseEstimatorParams, KeypointOrder, PoseLayout};

use decode::{Decoder, Scratch};

/// A loaded pose estimator of another tool.
pub struct ImportedPoseEstimator {
    params: ImportedPoseEstimatorParams,
    classes: Classes,
    network: ExportedNetwork,
    decoder: Decoder,
    scratch: Pool<Scratch>,
}

impl Learner for ImportedPoseEstimator {
    const SPEC: Spec = Spec::new("pose_estimator", Task::PoseEstimation)
        .class("ImportedPoseEstimatorLearner")
        .about(
            "Runs your own pose estimator, exported to ONNX by another tool; recognises the layout of its outputs.",
        )
        .recognises_network(|onnx| NetworkKind::PoseEstimator.recognises(onnx));
    type Params = ImportedPoseEstimatorParams;
    type Input<'a> = &'a Image;
    type Target = PoseList;
    type State = ();

    fn load(model: &Model, mut params: ImportedPoseEstimatorParams, device: Device) -> Result<Self> {
        let (session, facts) = Facts::open(model, device)?;
        let image = ImageInput::find(&facts, params.input.side())?;
        let classes = facts.classes(model);
        let recognised = convention::recognise(&facts)?;
        let (layout, input) = convention::settle(&mut params, recognised, &facts, &classes)?;
        let decoder = Decoder::find(layout, &facts)?;
        let network = ExportedNetwork::new(session, image, &input)?;
        Ok(Self { params, classes, network, decoder, scratch: Pool::default() })
    }

    fn params(&self) -> &ImportedPoseEstimatorParams {
        &self.params
    }

    fn params_mut(&mut self) -> &mut ImportedPoseEstimatorParams {
        &mut self.params
    }

    fn classes(&self) -> Classes {
        self.classes.clone()
    }

    fn infer_into(&self, _: &mut (), image: &Image, poses: &mut PoseList) -> Result<()> {
        let scratch = &mut *self.scratch.take();
        let ImportedPoseEstimatorParams { threshold, keypoint_threshold, .. } = self.params;
        // The network has suppressed detections already: no IoU exceeds 1.
        let is_final = self.params.layout == PoseLayout::Detections;
        let suppression = Suppression {
            kind: self.params.suppression,
            iou_threshold: if is_final { 1.0 } else { self.params.iou_threshold },
            threshold,
            max_boxes: self.params.max_poses,
        };
        self.network.run(image.view(), |outputs, geometry| {
            self.decoder.run(outputs, self.classes.len(), threshold, scratch)?;
            suppression.run(&mut scratch.candidates, &mut scratch.marks);
            let candidates = &scratch.candidates;
            let classes = &self.classes;
            self.decoder.write(&mut poses.poses, outputs, candidates, geometry, classes, keypoint_threshold)
        })
    }
}
