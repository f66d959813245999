//! Parameters of [`super::ImportedPoseEstimator`]: its settings, and what is to be known of a network's outputs.

use opendr_engine::params::Params;
use opendr_engine::target::Skeleton;
use opendr_engine::{Error, Result};
use opendr_perception_common::exported_network::InputParams;
use opendr_perception_common::suppression::SuppressionKind;

opendr_engine::choices! {
    /// What the outputs of a pose estimator are.
    pub enum PoseLayout {
        /// Recognised from the network.
        Auto = "auto",
        /// Box, class scores and keypoints of every cell, before suppression (YOLOv8-pose, YOLO11-pose).
        Candidates = "candidates",
        /// Box, score, class and keypoints of every detection, after suppression (YOLO26-pose).
        Detections = "detections",
        /// Boxes with scores, and keypoints, in one output each (RTMO).
        Lists = "lists",
    }
}

opendr_engine::choices! {
    /// The skeleton of a network's keypoints.
    pub enum KeypointOrder {
        /// 17 keypoints of persons, or of a single class without a name, are those of COCO; others have no names.
        Auto = "auto",
        /// COCO's 17 joints; predictions have OpenDR's 18, with the neck between the shoulders.
        Coco17 = "coco17",
        /// BlazePose's 33 points of a person.
        Blazepose33 = "blazepose33",
        /// MediaPipe's 21 joints of a left hand.
        LeftHand21 = "left_hand21",
        /// MediaPipe's 21 joints of a right hand.
        RightHand21 = "right_hand21",
        /// Keypoints without names.
        Points = "points",
    }
}

impl KeypointOrder {
    /// Settles the skeleton of a number of keypoints: 17 of persons are COCO's unless another skeleton is set.
    ///
    /// # Errors
    /// `Unsupported` when the skeleton has another number of keypoints.
    pub(in crate::pose_estimation) fn settle(
        &mut self,
        keypoints: usize,
        is_person: bool,
    ) -> Result<Skeleton> {
        if *self == Self::Auto {
            let is_coco = is_person && keypoints == Skeleton::Coco17.joints().len();
            *self = if is_coco { Self::Coco17 } else { Self::Points };
        }
        let skeleton = self.skeleton().unwrap_or(Skeleton::Points);
        if skeleton.has(keypoints) {
            return Ok(skeleton);
        }
        Err(Error::unsupported(format!(
            "the network has {keypoints} keypoints, and the skeleton {} {}; set another skeleton",
            skeleton.name(),
            skeleton.joints().len()
        )))
    }

    /// Returns the skeleton; `None` if it is not settled.
    const fn skeleton(self) -> Option<Skeleton> {
        Some(match self {
            Self::Auto => return None,
            Self::Coco17 => Skeleton::Coco17,
            Self::Blazepose33 => Skeleton::Blazepose33,
            Self::LeftHand21 => Skeleton::LeftHand21,
            Self::RightHand21 => Skeleton::RightHand21,
            Self::Points => Skeleton::Points,
        })
    }
}

/// Parameters of [`super::ImportedPoseEstimator`].
#[derive(Debug, Clone, Params)]
pub struct ImportedPoseEstimatorParams {
    /// Score below which poses are dropped.
    #[param(default = 0.25, range = 0.0..=1.0, live)]
    pub threshold: f32,
    /// Score below which keypoints are missing.
    #[param(default = 0.5, range = 0.0..=1.0, live)]
    pub keypoint_threshold: f32,
    /// IoU of the boxes above which candidates of one class count as one object; detections are not suppressed.
    #[param(default = 0.65, range = 0.0..=1.0, live)]
    pub iou_threshold: f32,
    /// Maximum number of poses per image.
    #[param(default = 100, range = 1..=1000, live)]
    pub max_poses: usize,
    /// Method of non-maximum suppression of candidates.
    #[param(live)]
    pub suppression: SuppressionKind,
    /// What the outputs are.
    pub layout: PoseLayout,
    /// Number of keypoints of a pose; recognised from the network if absent.
    #[param(range = 1..=144)]
    pub keypoints: Option<usize>,
    /// Number of values of a keypoint: 2 (position) or 3 (position and score); recognised from the network if absent.
    #[param(range = 2..=3)]
    pub keypoint_values: Option<usize>,
    /// Skeleton of the keypoints.
    pub skeleton: KeypointOrder,
    /// The network's input.
    #[param(flatten)]
    pub input: InputParams,
}
