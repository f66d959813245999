//! Vectors of the plane.

pub(crate) type Vector2 = [f64; 2];

pub(crate) fn plus(a: Vector2, b: Vector2, scale: f64) -> Vector2 {
    [a[0] + scale * b[0], a[1] + scale * b[1]]
}

pub(crate) fn dot(a: Vector2, b: Vector2) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

pub(crate) fn cross(a: Vector2, b: Vector2) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

pub(crate) fn norm(a: Vector2) -> f64 {
    dot(a, a).sqrt()
}

/// Velocities: m/s along x and y, rad/s, and m/s of the slide.
pub(super) type Velocity = [f64; 4];

/// Returns the vector turned by a right angle to the left.
pub(crate) fn left(a: Vector2) -> Vector2 {
    [-a[1], a[0]]
}

/// Returns the vector turned by the angle with this sine and cosine.
pub(crate) fn turned(a: Vector2, (sine, cosine): (f64, f64)) -> Vector2 {
    [cosine * a[0] - sine * a[1], sine * a[0] + cosine * a[1]]
}

/// Returns the vector at a length of 1, or zero for zero.
pub(crate) fn unit(a: Vector2) -> Vector2 {
    match norm(a) {
        length if length > 0.0 => a.map(|part| part / length),
        _ => [0.0; 2],
    }
}

/// Returns the vector, shortened to `limit` where it is longer.
pub(crate) fn limited(a: Vector2, limit: f64) -> Vector2 {
    let length = norm(a);
    if length > limit { a.map(|part| part * limit / length) } else { a }
}
