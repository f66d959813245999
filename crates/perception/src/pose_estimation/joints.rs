//! Joints of one skeleton as those of another.

use opendr_engine::target::{Keypoint, Pose, Skeleton};

const NECK: &str = "neck";
const SHOULDERS: [&str; 2] = ["l_sho", "r_sho"];

/// OpenDR's 18 joints of a pose of any skeleton, by their names; a neck that it lacks is the middle of the shoulders,
/// with the lower of their scores.
pub(crate) fn opendr_joints(pose: &Pose) -> [Keypoint; 18] {
    let found = |name: &str| pose.keypoint(name).copied().filter(Keypoint::is_found);
    let mut joints = [Keypoint::MISSING; 18];
    for (joint, name) in joints.iter_mut().zip(Skeleton::Opendr18.joints()) {
        let between = || {
            let [left, right] = SHOULDERS.map(found);
            let (left, right) = (left?, right?);
            Some(Keypoint {
                x: (left.x + right.x) / 2.0,
                y: (left.y + right.y) / 2.0,
                confidence: left.confidence.min(right.confidence),
            })
        };
        let is_made = *name == NECK && pose.skeleton.joint(NECK).is_none();
        *joint = if is_made { between() } else { found(name) }.unwrap_or(Keypoint::MISSING);
    }
    joints
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pose(skeleton: Skeleton) -> Pose {
        let joint = |at: usize| Keypoint { x: at as f32, y: 2.0 * at as f32, confidence: 0.5 };
        let keypoints = (0..skeleton.joints().len()).map(joint).collect();
        Pose { keypoints, skeleton, ..Pose::default() }
    }

    #[test]
    fn joints_keep_their_names() {
        let own = opendr_joints(&pose(Skeleton::Opendr18));
        assert!(own.iter().enumerate().all(|(at, joint)| joint.x == at as f32));
        let mut coco = pose(Skeleton::Coco17);
        let joints = opendr_joints(&coco);
        for (name, joint) in Skeleton::Opendr18.joints().iter().zip(joints) {
            match Skeleton::Coco17.joint(name) {
                Some(at) => assert_eq!(joint.x, at as f32, "{name}"),
                None => assert_eq!((joint.x, joint.y), (5.5, 11.0), "{name}"),
            }
        }
        coco.keypoints[5] = Keypoint::MISSING;
        assert_eq!(opendr_joints(&coco)[1], Keypoint::MISSING);
        coco.keypoints.clear();
        assert_eq!(opendr_joints(&coco), [Keypoint::MISSING; 18]);
    }
}
