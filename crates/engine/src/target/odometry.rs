//! The pose of a moving sensor.

use std::fmt;

use serde::{Deserialize, Serialize};

use crate::Header;
use crate::target::Action;

/// A position and an orientation in space.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct RigidPose {
    /// Position in metres.
    pub position: [f64; 3],
    /// Orientation as a quaternion `[x, y, z, w]` of length 1.
    pub orientation: [f64; 4],
}

impl Default for RigidPose {
    fn default() -> Self {
        Self { position: [0.0; 3], orientation: [0.0, 0.0, 0.0, 1.0] }
    }
}

/// The pose of a camera in the frame of its first image: x to the right, y down, z ahead.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Odometry {
    /// Header of the image.
    #[serde(flatten)]
    pub header: Header,
    /// Pose of the camera, `world_from_camera`; `None` where it is unknown, because tracking begins or is lost.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pose: Option<RigidPose>,
    /// Number of landmarks that agree with the pose; 0 where it is unknown.
    #[serde(default)]
    pub num_landmarks: u32,
    /// Proposed camera motion for a better view.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub action: Option<Action>,
}

impl Odometry {
    /// Creates the odometry of a known pose.
    pub fn new(pose: RigidPose, num_landmarks: u32) -> Self {
        Self { pose: Some(pose), num_landmarks, ..Self::default() }
    }
}

target!(Odometry, |_| None);

/// Writes position and orientation as in a line of a TUM trajectory: `tx ty tz qx qy qz qw`; with `{:#}`, a readable line. An unknown pose
/// is `unknown`.
impl fmt::Display for Odometry {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Some(RigidPose { position: [x, y, z], orientation: [qx, qy, qz, qw] }) = self.pose else {
            return if f.alternate() { writeln!(f, "pose unknown") } else { f.write_str("unknown") };
        };
        if f.alternate() {
            return writeln!(
                f,
                "x {x:.3} y {y:.3} z {z:.3} m, orientation {qx:.4} {qy:.4} {qz:.4} {qw:.4}, {} landmarks",
                self.num_landmarks
            );
        }
        write!(f, "{x:.6} {y:.6} {z:.6} {qx:.7} {qy:.7} {qz:.7} {qw:.7}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texts() {
        let pose = RigidPose { position: [1.0, -2.5, 0.125], ..RigidPose::default() };
        let odometry = Odometry::new(pose, 80);
        assert_eq!(
            odometry.to_string(),
            "1.000000 -2.500000 0.125000 0.0000000 0.0000000 0.0000000 1.0000000"
        );
        assert_eq!(
            format!("{odometry:#}"),
            "x 1.000 y -2.500 z 0.125 m, orientation 0.0000 0.0000 0.0000 1.0000, 80 landmarks\n"
        );
        assert_eq!(Odometry::default().to_string(), "unknown");
        assert_eq!(format!("{:#}", Odometry::default()), "pose unknown\n");
    }
}
