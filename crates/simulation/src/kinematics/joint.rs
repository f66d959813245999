//! A joint of an arm.

use super::transform::Transform;

/// A joint that turns about an axis.
#[derive(Debug, Clone, PartialEq)]
pub struct Joint {
    /// Name in the URDF.
    pub name: String,
    /// Pose of the joint at angle 0 in the frame of the joint before it.
    pub origin: Transform,
    /// Axis of the rotation in the frame of the joint, a unit vector.
    pub axis: [f64; 3],
    /// Smallest and largest angle in radians; none for a continuous joint.
    pub range: Option<[f64; 2]>,
}
