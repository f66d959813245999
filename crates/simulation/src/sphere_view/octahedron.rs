//! The sphere of directions as a square (Praun and Hoppe, Spherical parametrization and remeshing, 2003): no trigonometry, no
//! poles.

use crate::raycast::{Vector, unit};

/// The direction of a point of the square, each coordinate in -1..=1; length 1.
pub(super) fn direction([u, v]: [f32; 2]) -> Vector {
    let z = 1.0 - u.abs() - v.abs();
    let folded = |one: f32, other: f32| (1.0 - other.abs()) * 1.0_f32.copysign(one);
    let [x, y] = if z < 0.0 { [folded(u, v), folded(v, u)] } else { [u, v] };
    unit([x, y, z])
}

/// The point of the square of a direction of any length.
pub(super) fn point([x, y, z]: Vector) -> [f32; 2] {
    let inverse = 1.0 / (x.abs() + y.abs() + z.abs()).max(1e-12);
    let [u, v] = [x * inverse, y * inverse];
    match z < 0.0 {
        true => [(1.0 - v.abs()) * 1.0_f32.copysign(u), (1.0 - u.abs()) * 1.0_f32.copysign(v)],
        false => [u, v],
    }
}
