//! Rigid frames of bones.

use crate::raycast::{Vector, along};

/// A position with three orthonormal axes: ahead, left and up.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Frame {
    pub position: Vector,
    pub axes: [Vector; 3],
}

/// Axes of rotation.
pub(super) const AHEAD: usize = 0;
pub(super) const LEFT: usize = 1;
pub(super) const UP: usize = 2;

impl Frame {
    /// Returns an upright frame that faces `yaw`, rad.
    pub fn upright(position: Vector, yaw: f32) -> Self {
        let axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        Self { position, axes }.turned(UP, yaw)
    }

    /// Returns the frame rotated about one of its own axes by `angle`, rad, counter-clockwise.
    pub fn turned(mut self, axis: usize, angle: f32) -> Self {
        let (sine, cosine) = angle.sin_cos();
        let (first, second) = ((axis + 1) % 3, (axis + 2) % 3);
        let (a, b) = (self.axes[first], self.axes[second]);
        self.axes[first] = std::array::from_fn(|part| cosine * a[part] + sine * b[part]);
        self.axes[second] = std::array::from_fn(|part| cosine * b[part] - sine * a[part]);
        self
    }

    /// Returns the world point of a point in this frame.
    pub fn point(&self, [ahead, left, up]: Vector) -> Vector {
        let point = along(self.position, self.axes[AHEAD], ahead);
        along(along(point, self.axes[LEFT], left), self.axes[UP], up)
    }

    /// Returns the frame moved to a point in this frame.
    pub fn moved(mut self, offset: Vector) -> Self {
        self.position = self.point(offset);
        self
    }
}
