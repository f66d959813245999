//! Rotations and poses (SE(3)).

use super::vector::{Vector, cross, dot, length, minus, plus, scaled, skew, unit};

/// Rows of a rotation matrix.
pub type Rotation = [[f64; 3]; 3];

/// A rigid motion: the pose of a frame in its parent, `parent_from_frame`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pose {
    /// Rows of the rotation matrix.
    pub rotation: Rotation,
    /// Origin of the frame in its parent, in metres.
    pub position: [f64; 3],
}

impl Default for Pose {
    fn default() -> Self {
        Self::IDENTITY
    }
}

impl Pose {
    /// The identity.
    pub const IDENTITY: Self =
        Self { rotation: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]], position: [0.0; 3] };

    /// Creates a pose from the three rows of `[rotation | position]`; the rotation is orthonormalised.
    pub fn from_rows(rows: [[f64; 4]; 3]) -> Self {
        let rotation = rows.map(|[x, y, z, _]| [x, y, z]);
        Self { rotation: orthonormal(rotation), position: rows.map(|row| row[3]) }
    }

    /// Returns the rows of `[rotation | position]`.
    pub fn rows(&self) -> [[f64; 4]; 3] {
        std::array::from_fn(|row| {
            let [x, y, z] = self.rotation[row];
            [x, y, z, self.position[row]]
        })
    }

    /// Creates a pose from a quaternion `[x, y, z, w]`, which is normalised first; zero gives no rotation.
    pub fn from_quaternion(position: [f64; 3], quaternion: [f64; 4]) -> Self {
        let size = quaternion.iter().map(|part| part * part).sum::<f64>().sqrt();
        let [x, y, z, w] = if size > 0.0 { quaternion.map(|part| part / size) } else { [0.0, 0.0, 0.0, 1.0] };
        let rotation = [
            [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)],
            [2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x)],
            [2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)],
        ];
        Self { rotation, position }
    }

    /// Returns the rotation as a quaternion `[x, y, z, w]` with w >= 0 (Shepperd's method).
    pub fn quaternion(&self) -> [f64; 4] {
        let [[a, b, c], [d, e, f], [g, h, i]] = self.rotation;
        let traces = [1.0 + a - e - i, 1.0 - a + e - i, 1.0 - a - e + i, 1.0 + a + e + i];
        let largest = (1..4).fold(0, |best, at| if traces[at] > traces[best] { at } else { best });
        let size = traces[largest];
        let quaternion = match largest {
            0 => [size, b + d, c + g, h - f],
            1 => [b + d, size, f + h, c - g],
            2 => [c + g, f + h, size, d - b],
            _ => [h - f, c - g, d - b, size],
        };
        let norm = quaternion.iter().map(|part| part * part).sum::<f64>().sqrt();
        let sign = if quaternion[3] < 0.0 { -1.0 } else { 1.0 };
        quaternion.map(|part| sign * part / norm)
    }

    /// Returns the pose in the parent of a pose in this frame.
    #[must_use]
    pub fn then(&self, next: &Self) -> Self {
        Self { rotation: product(&self.rotation, &next.rotation), position: self.point(next.position) }
    }

    /// Returns the inverse.
    #[must_use]
    pub fn inverse(&self) -> Self {
        let rotation = transposed(&self.rotation);
        Self { rotation, position: scaled(times(&rotation, self.position), -1.0) }
    }

    /// Returns a point of this frame in the parent.
    pub fn point(&self, point: [f64; 3]) -> [f64; 3] {
        plus(times(&self.rotation, point), self.position)
    }

    /// Returns a point of the parent in this frame.
    pub fn point_in_frame(&self, point: [f64; 3]) -> [f64; 3] {
        let aside = minus(point, self.position);
        std::array::from_fn(|column| (0..3).map(|row| self.rotation[row][column] * aside[row]).sum())
    }

    /// Returns the angle of the rotation, in radians, 0 to pi.
    pub fn angle(&self) -> f64 {
        length(logarithm(&self.rotation))
    }

    /// Returns the rotation vector (axis times angle in radians).
    pub fn rotation_vector(&self) -> [f64; 3] {
        logarithm(&self.rotation)
    }

    /// Returns whether all numbers are finite.
    pub fn is_finite(&self) -> bool {
        self.rows().as_flattened().iter().all(|part| part.is_finite())
    }
}

pub(super) fn times(matrix: &Rotation, vector: Vector) -> Vector {
    matrix.map(|row| dot(row, vector))
}

pub(super) fn product(a: &Rotation, b: &Rotation) -> Rotation {
    a.map(|row| std::array::from_fn(|column| (0..3).map(|at| row[at] * b[at][column]).sum()))
}

pub(super) fn transposed(matrix: &Rotation) -> Rotation {
    std::array::from_fn(|row| std::array::from_fn(|column| matrix[column][row]))
}

/// Returns the rotation about a vector by its length in radians (Rodrigues).
pub(crate) fn exponential(vector: Vector) -> Rotation {
    let square = dot(vector, vector);
    let angle = square.sqrt();
    // The series near zero, where the quotients lose their digits.
    let (first, second) = if angle < 1e-4 {
        (1.0 - square / 6.0, 0.5 - square / 24.0)
    } else {
        (angle.sin() / angle, (1.0 - angle.cos()) / square)
    };
    let skew = skew(vector);
    let squared = product(&skew, &skew);
    std::array::from_fn(|row| {
        std::array::from_fn(|column| {
            let one = if row == column { 1.0 } else { 0.0 };
            one + first * skew[row][column] + second * squared[row][column]
        })
    })
}

/// Returns the rotation vector of a rotation.
pub(crate) fn logarithm(rotation: &Rotation) -> Vector {
    let pose = Pose { rotation: *rotation, position: [0.0; 3] };
    let [x, y, z, w] = pose.quaternion();
    let sine = length([x, y, z]);
    if sine < 1e-12 {
        return scaled([x, y, z], 2.0);
    }
    scaled([x, y, z], 2.0 * sine.atan2(w) / sine)
}

/// Returns the rows orthonormalised (Gram and Schmidt), against the rounding of long products.
pub(super) fn orthonormal([first, second, _]: Rotation) -> Rotation {
    let first = unit(first);
    let second = unit(minus(second, scaled(first, dot(first, second))));
    [first, second, cross(first, second)]
}
