//! Poses of cameras.

use super::{Vector, cross, unit};

/// A position with the axes ahead (x), left (y) and up (z), as in ROS (REP 103).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pose {
    /// Position in the world, in metres.
    pub position: Vector,
    /// Axes ahead, left and up: unit vectors in world coordinates.
    pub axes: [Vector; 3],
}

impl Pose {
    /// Creates an upright pose with a yaw of this sine and cosine.
    pub fn level(position: Vector, (sine, cosine): (f32, f32)) -> Self {
        Self { position, axes: [[cosine, sine, 0.0], [-sine, cosine, 0.0], [0.0, 0.0, 1.0]] }
    }

    /// Creates a pose at `position` that looks at `target`, with the image as upright as possible.
    pub fn looking_at(position: Vector, target: Vector) -> Self {
        let ahead = unit(std::array::from_fn(|axis| target[axis] - position[axis]));
        let left = cross([0.0, 0.0, 1.0], ahead);
        // Straight up or down, left is undefined; the world's y axis is used.
        let left = if left == [0.0; 3] { [0.0, 1.0, 0.0] } else { unit(left) };
        Self { position, axes: [ahead, left, cross(ahead, left)] }
    }

    /// Rotates a direction from this frame into the world.
    pub fn to_world(&self, [ahead, left, up]: Vector) -> Vector {
        let [x, y, z] = self.axes;
        std::array::from_fn(|axis| ahead * x[axis] + left * y[axis] + up * z[axis])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::raycast::{dot, length};

    #[test]
    fn axes_are_orthonormal() {
        for pose in [
            Pose::level([1.0; 3], (0.6, 0.8)),
            Pose::looking_at([0.0; 3], [3.0, -2.0, 1.0]),
            Pose::looking_at([0.0; 3], [0.0, 0.0, -4.0]),
        ] {
            let [ahead, left, up] = pose.axes;
            for axis in pose.axes {
                assert!((length(axis) - 1.0).abs() < 1e-6, "{pose:?}");
            }
            assert!(dot(cross(ahead, left), up) > 0.999_99, "{pose:?}");
        }
        assert!(Pose::looking_at([0.0; 3], [3.0, -2.0, 1.0]).axes[2][2] > 0.9);
    }
}
