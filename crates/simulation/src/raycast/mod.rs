//! Rays against bodies of simple shapes: depth, normals, labels, distances, and movements that miss nothing.
//!
//! Lengths in metres, in any one frame ("world"); a body has a frame of its own, in which its shape is centred.

mod body;
mod packet;
mod scene;
mod shape;
#[cfg(test)]
mod tests;

pub use body::Body;
pub use packet::{LANES, RayPacket};
pub use scene::{Hit, Scene};
pub use shape::Shape;

/// A point or direction.
pub type Vector = [f32; 3];

pub(crate) fn dot(a: Vector, b: Vector) -> f32 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn length(a: Vector) -> f32 {
    dot(a, a).sqrt()
}

fn minus(a: Vector, b: Vector) -> Vector {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// The point at `distance` from `origin`.
fn along(origin: Vector, direction: Vector, distance: f32) -> Vector {
    std::array::from_fn(|axis| origin[axis] + distance * direction[axis])
}
