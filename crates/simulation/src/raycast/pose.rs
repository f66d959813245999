//! Where a camera stands and where it looks.

use super::{Vector, cross, unit};

/// A position with three axes: ahead (x), left (y) and up (z), as robots have them (REP 103).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pose {
    /// In the world, metres.
    pub position: Vector,
    /// Ahead, left and up: unit vectors of the world.
    pub axes: [Vector; 3],
}

impl Pose {
    /// Upright, turned to the left of the world's x axis by an angle of this sine and cosine.
    pub fn level(position: Vector, (sine, cosine): (f32, f32)) -> Self {
        Self { position, axes: [[cosine, sine, 0.0], [-sine, cosine, 0.0], [0.0, 0.0, 1.0]] }
    }

    /// At `position`, with `target` in the middle of the picture and up as far up as can be.
    pub fn looking(position: Vector, target: Vector) -> Self {
        let ahead = unit(std::array::from_fn(|axis| target[axis] - position[axis]));
        let left = cross([0.0, 0.0, 1.0], ahead);
        // Straight up or down there is no left: the world's is as good as any.
        let left = if left == [0.0; 3] { [0.0, 1.0, 0.0] } else { unit(left) };
        Self { position, axes: [ahead, left, cross(ahead, left)] }
    }

    /// The direction in the world of a direction seen from here.
    pub fn turned(&self, [ahead, left, up]: Vector) -> Vector {
        let [x, y, z] = self.axes;
        std::array::from_fn(|axis| ahead * x[axis] + left * y[axis] + up * z[axis])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::raycast::{dot, length};

    #[test]
    fn axes_are_a_frame() {
        for pose in [
            Pose::level([1.0; 3], (0.6, 0.8)),
            Pose::looking([0.0; 3], [3.0, -2.0, 1.0]),
            Pose::looking([0.0; 3], [0.0, 0.0, -4.0]),
        ] {
            let [ahead, left, up] = pose.axes;
            for axis in pose.axes {
                assert!((length(axis) - 1.0).abs() < 1e-6, "{pose:?}");
            }
            assert!(dot(cross(ahead, left), up) > 0.999_99, "{pose:?}");
        }
        assert!(Pose::looking([0.0; 3], [3.0, -2.0, 1.0]).axes[2][2] > 0.9);
    }
}
