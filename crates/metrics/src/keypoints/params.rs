//! Parameters of the keypoint metrics.

use opendr_engine::params::Params;

opendr_engine::choices! {
    /// Size by which the distances of joints are divided.
    pub enum PoseSize {
        /// The longer side of the pose's box (PCK of MMPose).
        Box = "box",
        /// The square root of the area of the pose's box (NME of faces).
        Area = "area",
        /// 0.6 times the diagonal of the pose's box, which is the box of the head (PCKh of MPII).
        Head = "head",
        /// The distance from the left shoulder to the right hip.
        Torso = "torso",
        /// The distance between two joints, or between the means of two halves of a list of joints.
        Joints = "joints",
    }
}

/// Parameters of [`Keypoints`](super::Keypoints).
#[derive(Debug, Clone, Params)]
pub struct KeypointsParams {
    /// Normalisation of the distances.
    pub normalize: PoseSize,
    /// For `joints`: an even number of joint indices. Distances are divided by the distance between the mean of the first half
    /// and that of the second, e.g. the outer corners of the eyes (300-W: 36, 45) or the points around each eye.
    pub joints: Vec<usize>,
    /// Threshold of the normalised distance of correct joints.
    #[param(default = 0.2, range = 0.0..=10.0)]
    pub threshold: f64,
}
