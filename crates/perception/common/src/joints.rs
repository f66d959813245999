//! Joints of a pose by name, converted between skeletons.

use opendr_engine::target::{Keypoint, Pose};

const SHOULDERS: [&str; 2] = ["l_sho", "r_sho"];
const HIPS: [&str; 2] = ["l_hip", "r_hip"];

/// Returns OpenDR's 18 joints of a pose of any skeleton, converted by [`joint_of`].
#[cfg(feature = "training")]
pub fn opendr_joints_from_pose(pose: &Pose) -> [Keypoint; 18] {
    let mut joints = [Keypoint::MISSING; 18];
    for (joint, name) in joints.iter_mut().zip(opendr_engine::target::Skeleton::Opendr18.joints()) {
        *joint = joint_of(pose, name).unwrap_or(Keypoint::MISSING);
    }
    joints
}

/// Returns the joint called `name`, if it was detected. A joint that the pose's skeleton lacks is derived from others: the
/// neck is the middle of the shoulders, the pelvis that of the hips, the belly that of both, and nose, face and head stand
/// for each other. A joint between two others has the lower of their scores.
pub fn joint_of(pose: &Pose, name: &str) -> Option<Keypoint> {
    let found = |name: &str| pose.keypoint(name).copied().filter(Keypoint::is_detected);
    if pose.skeleton.joint(name).is_some() {
        return found(name);
    }
    let middle = |[one, other]: [&str; 2]| Some(middle_of(found(one)?, found(other)?));
    match name {
        "neck" => middle(SHOULDERS),
        "pelvis" => middle(HIPS),
        "belly" => Some(middle_of(middle(SHOULDERS)?, middle(HIPS)?)),
        "face" | "head" | "nose" => ["nose", "face", "head"].into_iter().find_map(found),
        _ => None,
    }
}

fn middle_of(one: Keypoint, other: Keypoint) -> Keypoint {
    Keypoint {
        x: (one.x + other.x) / 2.0,
        y: (one.y + other.y) / 2.0,
        confidence: one.confidence.min(other.confidence),
    }
}

#[cfg(test)]
#[cfg(feature = "training")]
mod tests {
    use opendr_engine::target::Skeleton;

    use super::*;

    fn pose(skeleton: Skeleton) -> Pose {
        let joint = |at: usize| Keypoint { x: at as f32, y: 2.0 * at as f32, confidence: 0.5 };
        let keypoints = (0..skeleton.joints().len()).map(joint).collect();
        Pose { keypoints, skeleton, ..Pose::default() }
    }

    #[test]
    fn joints_keep_their_names() {
        let own = opendr_joints_from_pose(&pose(Skeleton::Opendr18));
        assert!(own.iter().enumerate().all(|(at, joint)| joint.x == at as f32));
        let mut coco = pose(Skeleton::Coco17);
        let joints = opendr_joints_from_pose(&coco);
        for (name, joint) in Skeleton::Opendr18.joints().iter().zip(joints) {
            match Skeleton::Coco17.joint(name) {
                Some(at) => assert_eq!(joint.x, at as f32, "{name}"),
                None => assert_eq!((joint.x, joint.y), (5.5, 11.0), "{name}"),
            }
        }
        coco.keypoints[5] = Keypoint::MISSING;
        assert_eq!(opendr_joints_from_pose(&coco)[1], Keypoint::MISSING);
        coco.keypoints.clear();
        assert_eq!(opendr_joints_from_pose(&coco), [Keypoint::MISSING; 18]);
    }

    #[test]
    fn joints_that_a_skeleton_lacks_lie_between_others() {
        let pose = pose(Skeleton::Coco17);
        // COCO's shoulders are joints 5 and 6, its hips 11 and 12.
        let x = |name: &str| joint_of(&pose, name).map(|joint| joint.x);
        assert_eq!(["neck", "pelvis", "belly", "face"].map(x), [Some(5.5), Some(11.5), Some(8.5), Some(0.0)]);
        assert_eq!((x("r_thumb"), x("l_wri")), (None, Some(9.0)));
    }
}
