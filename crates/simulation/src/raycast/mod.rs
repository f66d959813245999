//! Ray casting against simple shapes, height fields and meshes: depth, normals, labels, colours, distances, and collision
//! tests of moving balls.
//!
//! Lengths are in metres, in one world frame; a body has a frame of its own, in which its shape is centred.

mod body;
mod camera;
mod height_field;
mod mesh;
mod packet;
mod paint;
mod pose;
mod render;
mod scene;
mod shading;
mod shape;
#[cfg(test)]
mod tests;
mod triangle;

pub use body::Body;
pub use camera::{Camera, DepthBuffer};
pub use height_field::HeightField;
pub use mesh::Mesh;
pub use pose::Pose;
pub use scene::{Hit, Scene};
pub use shading::Shading;
pub use shape::Shape;

/// A point or direction.
pub type Vector = [f32; 3];

/// Rays that are processed together: one vector register of AVX-512, two of AVX2, four of NEON.
const LANES: usize = 16;

/// Directions of several rays: one array for each axis.
type Directions = [[f32; LANES]; 3];

pub(crate) fn dot(a: Vector, b: Vector) -> f32 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(crate) fn length(a: Vector) -> f32 {
    dot(a, a).sqrt()
}

pub(crate) fn minus(a: Vector, b: Vector) -> Vector {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

pub(crate) fn cross(a: Vector, b: Vector) -> Vector {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// Returns the vector scaled to length 1; up for the zero vector.
#[inline]
pub(crate) fn unit(vector: Vector) -> Vector {
    let size = length(vector);
    if size > 0.0 { vector.map(|part| part / size) } else { [0.0, 0.0, 1.0] }
}

/// Returns the point at `distance` from `origin`.
pub(crate) fn along(origin: Vector, direction: Vector, distance: f32) -> Vector {
    std::array::from_fn(|axis| origin[axis] + distance * direction[axis])
}
