//! Bodies: shapes with a pose.

use opendr_engine::{Error, Result};

use super::{Shape, Vector, dot, minus};

/// A shape with position, orientation and label.
#[derive(Debug, Clone, PartialEq)]
pub struct Body {
    shape: Shape,
    position: Vector,
    /// Rows are the axes of the body's frame, in world coordinates.
    body_from_world: [Vector; 3],
    label: u16,
}

impl Body {
    /// Creates a body rotated by the quaternion `[w, x, y, z]`, which is normalised first.
    ///
    /// # Errors
    /// `InvalidInput` when a size is not positive, a number not finite, or the quaternion zero.
    pub fn new(shape: Shape, position: Vector, rotation: [f32; 4], label: u16) -> Result<Self> {
        let size = rotation.iter().map(|part| part * part).sum::<f32>().sqrt();
        let is_finite = position.iter().all(|part| part.is_finite());
        if !shape.is_valid() || !is_finite || !(1e-6..1e6).contains(&size) {
            return Err(Error::invalid_input(format!(
                "{shape:?} at {position:?} turned by {rotation:?}; give positive sizes below 1e6, finite numbers and a rotation that is not 0"
            )));
        }
        let [w, x, y, z] = rotation.map(|part| part / size);
        let body_from_world = [
            [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y + w * z), 2.0 * (x * z - w * y)],
            [2.0 * (x * y - w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z + w * x)],
            [2.0 * (x * z + w * y), 2.0 * (y * z - w * x), 1.0 - 2.0 * (x * x + y * y)],
        ];
        Ok(Self { shape, position, body_from_world, label })
    }

    /// Creates a body with the axes of the world.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn upright(shape: Shape, position: Vector, label: u16) -> Result<Self> {
        Self::new(shape, position, [1.0, 0.0, 0.0, 0.0], label)
    }

    /// Returns the body at `position`, rotated by `yaw` about the vertical axis, counter-clockwise in radians.
    ///
    /// # Errors
    /// `InvalidInput` when a number is not finite.
    pub fn moved(&self, position: Vector, yaw: f32) -> Result<Self> {
        if !yaw.is_finite() || !position.iter().all(|part| part.is_finite()) {
            return Err(Error::invalid_input(format!(
                "the pose of a body is {position:?} with yaw {yaw}; give finite numbers"
            )));
        }
        let (sin, cos) = yaw.sin_cos();
        let body_from_world = self.body_from_world.map(|[x, y, z]| [x * cos - y * sin, x * sin + y * cos, z]);
        Ok(Self { position, body_from_world, ..self.clone() })
    }

    /// Returns the shape.
    pub fn shape(&self) -> &Shape {
        &self.shape
    }

    /// Returns the position of the origin of its frame.
    pub fn position(&self) -> Vector {
        self.position
    }

    /// Returns the axes of the body's frame, in world coordinates.
    pub fn axes(&self) -> [Vector; 3] {
        self.body_from_world
    }

    /// Returns the label.
    pub fn label(&self) -> u16 {
        self.label
    }

    /// Returns the distance of a world point from the surface; negative inside a solid.
    pub fn distance(&self, point: Vector) -> f32 {
        self.shape.distance(self.point_in_body(point))
    }

    pub(crate) fn point_in_body(&self, point: Vector) -> Vector {
        self.direction_in_body(minus(point, self.position))
    }

    pub(crate) fn direction_in_body(&self, direction: Vector) -> Vector {
        self.body_from_world.map(|axis| dot(axis, direction))
    }

    /// Returns the outward normal at a world point on the surface.
    pub(crate) fn normal(&self, point: Vector) -> Vector {
        let normal = self.shape.normal(self.point_in_body(point));
        std::array::from_fn(|axis| (0..3).map(|row| normal[row] * self.body_from_world[row][axis]).sum())
    }
}
