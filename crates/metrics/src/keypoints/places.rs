//! Positions of joints.

use opendr_engine::target::{Keypoint, Pose};

/// Returns the position of a joint; `None` if it is not annotated or not predicted.
pub(super) fn place_of(keypoint: &Keypoint) -> Option<[f64; 2]> {
    // NaN is not missing: it is passed on and rejected.
    let missing = keypoint.x < 0.0 || keypoint.y < 0.0;
    (!missing).then(|| [f64::from(keypoint.x), f64::from(keypoint.y)])
}

/// Returns the positions of the joints of `pose`, in the order of the skeleton of `reference`.
pub(super) fn places_like(reference: &Pose, pose: &Pose) -> Vec<Option<[f64; 2]>> {
    if reference.skeleton == pose.skeleton {
        return pose.keypoints.iter().map(place_of).collect();
    }
    let joints = reference.skeleton.joints().iter().take(reference.keypoints.len());
    joints.map(|joint| pose.keypoint(joint).and_then(place_of)).collect()
}
