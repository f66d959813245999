//! The pose estimators of the fall detector.

use opendr_engine::data::Image;
use opendr_engine::learner::Learner;
use opendr_engine::model::Model;
use opendr_engine::target::PoseList;
use opendr_engine::{Device, Result};

use super::params::FallDetectorParams;
use crate::pose_estimation::{
    LightweightOpenPose, LightweightOpenPoseParams, LightweightOpenPoseState, Movenet, MovenetParams,
    PoseTracks,
};

/// Name of the part of a model that is a MoveNet; without it the model's own network is a Lightweight OpenPose.
const MOVENET: &str = "movenet";

/// Detects and tracks persons.
pub(super) enum PoseFinder {
    LightweightOpenPose(Box<LightweightOpenPose>),
    Movenet(Box<Movenet>),
}

/// The persons of a stream.
#[derive(Default)]
pub(super) struct PoseFinderState {
    open_pose: LightweightOpenPoseState,
    tracks: PoseTracks,
}

impl PoseFinder {
    pub fn load(model: &Model, params: &FallDetectorParams, device: Device) -> Result<Self> {
        if model.parts().any(|name| name == MOVENET) {
            let movenet = Movenet::load(&model.part(MOVENET)?, movenet_params(params), device)?;
            return Ok(Self::Movenet(Box::new(movenet)));
        }
        let open_pose = LightweightOpenPose::load(model, open_pose_params(params), device)?;
        Ok(Self::LightweightOpenPose(Box::new(open_pose)))
    }

    /// Replaces `poses` by the persons in the image, each with its identity in the stream.
    pub fn follow(
        &self,
        params: &FallDetectorParams,
        state: &mut PoseFinderState,
        image: &Image,
        poses: &mut PoseList,
    ) -> Result<()> {
        match self {
            Self::LightweightOpenPose(network) => {
                network.follow_with(&open_pose_params(params), &mut state.open_pose, image, poses)
            }
            Self::Movenet(network) => {
                network.find_with(&movenet_params(params), image, poses)?;
                state.tracks.update(&image.header, &mut poses.poses, false);
                Ok(())
            }
        }
    }
}

fn open_pose_params(params: &FallDetectorParams) -> LightweightOpenPoseParams {
    LightweightOpenPoseParams {
        threshold: params.threshold,
        keypoint_threshold: params.keypoint_threshold,
        base_height: params.base_height,
        ..LightweightOpenPoseParams::default()
    }
}

fn movenet_params(params: &FallDetectorParams) -> MovenetParams {
    MovenetParams {
        threshold: params.threshold,
        keypoint_threshold: params.keypoint_threshold,
        ..MovenetParams::default()
    }
}
