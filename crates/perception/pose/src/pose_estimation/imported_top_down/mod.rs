//! Top-down pose estimator from an ONNX file that another tool exported: RTMPose, ViTPose, HRNet, SimpleBaseline.
//!
//! The network takes the crop of one person. Layout of inputs and outputs is recognised from the network; a parameter states what
//! cannot be recognised.

mod convention;
mod decode;
mod heatmap;
mod params;
mod person_box;

use opendr_engine::data::Image;
use opendr_engine::learner::{Inputs, Learner, Spec};
use opendr_engine::model::Model;
use opendr_engine::target::{
    BoundingBox, BoundingBoxList, Classes, Keypoint, Name, Pose, PoseList, Skeleton,
};
use opendr_engine::{Device, Pool, Result, Task};
use opendr_perception_common::exported_network::{ExportedNetwork, Facts, ImageInput, NetworkKind};

pub use params::{ImportedTopDownPoseEstimatorParams, KeypointLayout};

use super::opendr_from_coco;
use decode::{Decoder, Scratch};
use person_box::PersonBox;

/// An image, and the boxes of persons in it.
#[derive(Debug, Clone, Copy, Inputs)]
pub struct TopDownInputs<'a> {
    /// Image.
    pub image: &'a Image,
    /// Boxes of persons, or of other objects; without them the image shows one person.
    pub detections: Option<&'a BoundingBoxList>,
}

/// An image of one person.
impl<'a> From<&'a Image> for TopDownInputs<'a> {
    fn from(image: &'a Image) -> Self {
        Self { image, detections: None }
    }
}

/// A loaded top-down pose estimator of another tool.
pub struct ImportedTopDownPoseEstimator {
    params: ImportedTopDownPoseEstimatorParams,
    network: ExportedNetwork,
    /// Width and height of the network's input.
    size: [usize; 2],
    decoder: Decoder,
    skeleton: Skeleton,
    scratch: Pool<Scratch>,
}

impl Learner for ImportedTopDownPoseEstimator {
    const SPEC: Spec = Spec::new("top_down_pose_estimator", Task::PoseEstimation)
        .class("ImportedTopDownPoseEstimatorLearner")
        .about(
            "Runs your own top-down pose estimator, exported to ONNX by another tool, on the boxes of a detector.",
        )
        .recognises_network(|onnx| NetworkKind::TopDownPoseEstimator.recognises(onnx));
    type Params = ImportedTopDownPoseEstimatorParams;
    type Input<'a> = TopDownInputs<'a>;
    type Target = PoseList;
    type State = ();

    fn load(model: &Model, mut params: ImportedTopDownPoseEstimatorParams, device: Device) -> Result<Self> {
        let (session, facts) = Facts::open(model, device)?;
        let image = ImageInput::find(&facts, params.size.unwrap_or(convention::UNKNOWN))?;
        let settled = convention::settle(&mut params, convention::recognise(&facts), &facts, image.size)?;
        let network = ExportedNetwork::new(session, image, &settled.input)?;
        let (decoder, skeleton) = (settled.decoder, settled.skeleton);
        Ok(Self { params, network, size: image.size, decoder, skeleton, scratch: Pool::default() })
    }

    fn params(&self) -> &ImportedTopDownPoseEstimatorParams {
        &self.params
    }

    fn params_mut(&mut self) -> &mut ImportedTopDownPoseEstimatorParams {
        &mut self.params
    }

    fn infer_into(&self, _: &mut (), input: TopDownInputs<'_>, poses: &mut PoseList) -> Result<()> {
        let scratch = &mut *self.scratch.take();
        let mut count = 0;
        match input.detections {
            Some(detections) => {
                scratch.choose(&self.params, detections);
                for at in 0..scratch.chosen.len() {
                    let found = (&detections.boxes[scratch.chosen[at]], &detections.classes);
                    count += usize::from(self.add(scratch, input.image, found, count, &mut poses.poses)?);
                }
            }
            None => {
                let [width, height] = [input.image.width(), input.image.height()].map(|side| side as f32);
                let whole = BoundingBox { width, height, confidence: 1.0, ..BoundingBox::default() };
                let found = (&whole, &Classes::default());
                count += usize::from(self.add(scratch, input.image, found, count, &mut poses.poses)?);
            }
        }
        poses.poses.truncate(count);
        Ok(())
    }
}

impl ImportedTopDownPoseEstimator {
    /// Writes the pose in a box at `index`; returns whether there is one.
    fn add(
        &self,
        scratch: &mut Scratch,
        image: &Image,
        (found, classes): (&BoundingBox, &Classes),
        index: usize,
        poses: &mut Vec<Pose>,
    ) -> Result<bool> {
        let params = &self.params;
        let Some(person) = PersonBox::around(found, self.size, params.padding, params.layout) else {
            return Ok(false);
        };
        self.network.run_crop(image.view(), person.warp(), |outputs| {
            self.decoder.run(outputs, &person, &mut scratch.keypoints)
        })?;
        let [width, height] = [image.width(), image.height()].map(|side| side as f32);
        let (mut sum, mut detected) = (0.0, 0);
        for keypoint in &mut scratch.keypoints {
            let is_known = keypoint.confidence > 0.0 && keypoint.confidence >= params.keypoint_threshold;
            if !is_known {
                *keypoint = Keypoint::MISSING;
                continue;
            }
            (keypoint.x, keypoint.y) = (keypoint.x.clamp(0.0, width), keypoint.y.clamp(0.0, height));
            sum += keypoint.confidence;
            detected += 1;
        }
        if detected == 0 {
            return Ok(false);
        }
        if poses.len() == index {
            poses.push(Pose::default());
        }
        let pose = &mut poses[index];
        match (self.skeleton, scratch.keypoints.as_chunks::<17>()) {
            (Skeleton::Coco17, ([joints], [])) => opendr_from_coco(pose, joints, params.keypoint_threshold),
            (skeleton, _) => {
                pose.skeleton = skeleton;
                pose.keypoints.clear();
                pose.keypoints.extend_from_slice(&scratch.keypoints);
            }
        }
        pose.id = None;
        pose.confidence = sum / detected as f32;
        match &mut pose.region {
            Some(reused) => reused.as_mut().clone_from(found),
            None => pose.region = Some(Box::new(found.clone())),
        }
        if let (Name::Index(index), Some(region)) = (&found.name, &mut pose.region) {
            region.name = classes.name(*index).cloned().map_or_else(|| found.name.clone(), Name::Label);
        }
        Ok(true)
    }
}
