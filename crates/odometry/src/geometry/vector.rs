//! Vectors of three numbers.

/// A point or direction.
pub(crate) type Vector = [f64; 3];

pub(crate) fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(crate) fn length(a: Vector) -> f64 {
    dot(a, a).sqrt()
}

pub(crate) fn minus(a: Vector, b: Vector) -> Vector {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

pub(crate) fn plus(a: Vector, b: Vector) -> Vector {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

pub(crate) fn scaled(a: Vector, factor: f64) -> Vector {
    a.map(|part| factor * part)
}

/// Returns the point at `distance` from `origin`.
pub(crate) fn along(origin: Vector, direction: Vector, distance: f64) -> Vector {
    plus(origin, scaled(direction, distance))
}

pub(crate) fn distance(a: Vector, b: Vector) -> f64 {
    length(minus(a, b))
}

pub(crate) fn cross(a: Vector, b: Vector) -> Vector {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// Returns the vector scaled to length 1; zero stays zero.
pub(crate) fn unit(a: Vector) -> Vector {
    let size = length(a);
    if size > 0.0 { scaled(a, 1.0 / size) } else { a }
}

/// Returns the matrix of the cross product with a vector.
pub(crate) fn skew([x, y, z]: Vector) -> [Vector; 3] {
    [[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]]
}
