//! Human pose estimation in images.

mod blazepose;
mod high_resolution_pose_estimation;
mod imported_pose_estimator;
mod imported_top_down;
mod lightweight_open_pose;
mod movenet;
mod one_euro;
pub mod part_affinity;
mod pose_tracks;
mod posenet;

pub use blazepose::{BlazePose, BlazePoseParams, BlazePoseState};
pub use high_resolution_pose_estimation::{
    HighResolutionPoseEstimation, HighResolutionPoseEstimationParams, HighResolutionPoseEstimationState,
    RegionMethod,
};
pub use imported_pose_estimator::{
    ImportedPoseEstimator, ImportedPoseEstimatorParams, KeypointOrder, PoseLayout,
};
pub use imported_top_down::{
    ImportedTopDownPoseEstimator, ImportedTopDownPoseEstimatorParams, KeypointLayout, TopDownInputs,
};
#[cfg(feature = "training")]
pub use lightweight_open_pose::LightweightOpenPoseFitParams;
pub use lightweight_open_pose::{LightweightOpenPose, LightweightOpenPoseParams, LightweightOpenPoseState};
pub use movenet::{Movenet, MovenetParams};
use opendr_engine::target::{Keypoint, Pose, Skeleton};
pub(crate) use pose_tracks::PoseTracks;
pub use posenet::{Posenet, PosenetParams};

/// COCO's index of each of OpenDR's 18 joints; the neck (1) is derived from the shoulders.
const COCO_FROM_OPENDR: [usize; 18] = [0, usize::MAX, 6, 8, 10, 5, 7, 9, 12, 14, 16, 11, 13, 15, 2, 1, 4, 3];
const NECK: usize = 1;
const SHOULDERS: [usize; 2] = [5, 6];

/// Converts COCO's 17 joints to OpenDR's 18. Joints below `threshold` are missing; the neck is the middle of the shoulders
/// with the lower of their scores.
pub(crate) fn opendr_from_coco(pose: &mut Pose, joints: &[Keypoint; 17], threshold: f32) {
    pose.skeleton = Skeleton::Opendr18;
    pose.keypoints.clear();
    pose.keypoints.extend(COCO_FROM_OPENDR.iter().enumerate().map(|(joint, coco)| {
        let keypoint = if joint == NECK {
            let [left, right] = SHOULDERS.map(|shoulder| joints[shoulder]);
            Keypoint {
                x: (left.x + right.x) / 2.0,
                y: (left.y + right.y) / 2.0,
                confidence: left.confidence.min(right.confidence),
            }
        } else {
            joints[*coco]
        };
        if keypoint.confidence >= threshold { keypoint } else { Keypoint::MISSING }
    }));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn joints_keep_their_names() {
        for (joint, coco) in COCO_FROM_OPENDR.iter().enumerate() {
            let name = Skeleton::Opendr18.joints()[joint];
            assert_eq!(Skeleton::Coco17.joint(name), (joint != NECK).then_some(*coco));
        }
        assert_eq!(SHOULDERS.map(|joint| Skeleton::Coco17.joints()[joint]), ["l_sho", "r_sho"]);
    }

    #[test]
    fn neck_is_between_the_shoulders() {
        let mut joints = [Keypoint { x: 4.0, y: 4.0, confidence: 0.9 }; 17];
        joints[SHOULDERS[0]] = Keypoint { x: 10.0, y: 20.0, confidence: 0.5 };
        joints[SHOULDERS[1]] = Keypoint { x: 20.0, y: 22.0, confidence: 0.4 };
        let mut pose = Pose::default();
        opendr_from_coco(&mut pose, &joints, 0.45);
        assert_eq!(pose.keypoints.len(), 18);
        assert!(!pose.keypoints[NECK].is_detected());
        opendr_from_coco(&mut pose, &joints, 0.3);
        assert_eq!(pose.keypoints[NECK], Keypoint { x: 15.0, y: 21.0, confidence: 0.4 });
    }
}
