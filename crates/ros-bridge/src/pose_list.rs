//! Poses: `opendr_msgs/Pose2DArray`.

use opendr_engine::target::{Keypoint, Pose, PoseList, Skeleton};
use opendr_engine::{Error, Result};
use opendr_messages::opendr_msgs::{Pose2D, Pose2DArray, Pose2DKeypoint};

use crate::{FromToMessage, RosBridge, header_from_message, message_from_header};

/// Keypoints by name and position. The person boxes of data sets are not in the message.
impl FromToMessage<Pose2DArray> for PoseList {
    fn from_message(message: Pose2DArray, _: &RosBridge) -> Result<Self> {
        let poses = message.poses.iter().map(pose_from_message).collect::<Result<Vec<_>>>()?;
        Ok(Self { header: header_from_message(&message.header), ..Self::from(poses) })
    }

    fn to_message(&self, _: &RosBridge) -> Result<Pose2DArray> {
        let poses = self.poses.iter().map(message_from_pose).collect();
        Ok(Pose2DArray { header: message_from_header(&self.header)?, poses })
    }
}

fn message_from_pose(pose: &Pose) -> Pose2D {
    let names = pose.skeleton.joints();
    let joint = |(index, joint): (usize, &Keypoint)| Pose2DKeypoint {
        name: names.get(index).copied().unwrap_or_default().to_owned(),
        x: joint.x,
        y: joint.y,
        confidence: joint.confidence,
    };
    Pose2D {
        skeleton: pose.skeleton.name().to_owned(),
        keypoints: pose.keypoints.iter().enumerate().map(joint).collect(),
        confidence: pose.confidence,
        id: pose.id.unwrap_or(-1),
    }
}

fn pose_from_message(message: &Pose2D) -> Result<Pose> {
    let skeleton =
        Skeleton::ALL.iter().copied().find(|known| known.name() == message.skeleton).ok_or_else(|| {
            let known: Vec<_> = Skeleton::ALL.iter().map(|known| known.name()).collect();
            Error::format(format!(
                "the pose has the unknown skeleton {:?}; there are {}",
                message.skeleton,
                known.join(", ")
            ))
        })?;
    let joint = |joint: &Pose2DKeypoint| Keypoint { x: joint.x, y: joint.y, confidence: joint.confidence };
    Ok(Pose {
        keypoints: message.keypoints.iter().map(joint).collect(),
        confidence: message.confidence,
        id: (message.id >= 0).then_some(message.id),
        skeleton,
        region: None,
    })
}
