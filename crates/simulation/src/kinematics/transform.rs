//! Rigid transforms.

use crate::arctangent::{arccosine, arctangent2};
use crate::multirotor::{Matrix, Vector, axes, dot, minus, plus};
use crate::sine_cosine::sine_cosine;

/// A position and a rotation: a pose of a frame in another.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Transform {
    /// Origin of the frame, in metres.
    pub position: [f64; 3],
    /// Axes of the frame: the columns of the rotation matrix.
    pub rotation: [[f64; 3]; 3],
}

impl Default for Transform {
    fn default() -> Self {
        Self { position: [0.0; 3], rotation: IDENTITY }
    }
}

const IDENTITY: Matrix = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

impl Transform {
    /// Creates a translation.
    pub fn at(position: [f64; 3]) -> Self {
        Self { position, rotation: IDENTITY }
    }

    /// Creates the pose of a frame on the floor: x, y and yaw in radians.
    pub fn on_floor([x, y, yaw]: [f64; 3]) -> Self {
        Self { position: [x, y, 0.0], ..Self::about([0.0, 0.0, 1.0], yaw) }
    }

    /// Creates a rotation by `angle` radians about `axis`, a unit vector (Rodrigues).
    pub fn about(axis: [f64; 3], angle: f64) -> Self {
        let (sine, cosine) = sine_cosine(angle / 2.0);
        let [x, y, z] = axis.map(|part| part * sine);
        Self { position: [0.0; 3], rotation: axes([cosine, x, y, z]) }
    }

    /// Creates a rotation by roll, pitch and yaw about the fixed axes x, y, z, in radians.
    pub fn from_rpy([roll, pitch, yaw]: [f64; 3]) -> Self {
        let about = |axis: usize, angle| Self::about(IDENTITY[axis], angle);
        about(2, yaw).then(&about(1, pitch)).then(&about(0, roll))
    }

    /// Creates the transform of a position and a unit quaternion w, x, y, z.
    pub fn from_quaternion(position: [f64; 3], quaternion: [f64; 4]) -> Self {
        Self { position, rotation: axes(quaternion) }
    }

    /// Returns the unit quaternion w, x, y, z of the rotation; w is not negative (Shepperd, 1978).
    pub fn quaternion(&self) -> [f64; 4] {
        let [x, y, z] = self.rotation;
        let squares = [x[0] + y[1] + z[2], x[0] - y[1] - z[2], y[1] - x[0] - z[2], z[2] - x[0] - y[1]];
        let largest = (0..4).fold(0, |best, at| if squares[at] > squares[best] { at } else { best });
        let size = (1.0 + squares[largest]).max(0.0).sqrt() / 2.0;
        let share = 0.25 / size;
        let skew = [y[2] - z[1], z[0] - x[2], x[1] - y[0]].map(|part| part * share);
        let even = [x[1] + y[0], x[2] + z[0], y[2] + z[1]].map(|part| part * share);
        let found = match largest {
            0 => [size, skew[0], skew[1], skew[2]],
            1 => [skew[0], size, even[0], even[1]],
            2 => [skew[1], even[0], size, even[2]],
            _ => [skew[2], even[1], even[2], size],
        };
        if found[0] < 0.0 { found.map(|part| -part) } else { found }
    }

    /// Returns this transform after `other`: the pose of a frame whose pose is `other` in this frame.
    #[must_use]
    pub fn then(&self, other: &Self) -> Self {
        Self {
            position: plus(self.position, self.turn(other.position), 1.0),
            rotation: other.rotation.map(|axis| self.turn(axis)),
        }
    }

    /// Returns the inverse.
    #[must_use]
    pub fn inverse(&self) -> Self {
        let rotation: Matrix = std::array::from_fn(|column| self.rotation.map(|axis| axis[column]));
        let back = Self { position: [0.0; 3], rotation };
        Self { position: back.turn(self.position).map(|part| -part), rotation }
    }

    /// Returns the pose of `other` seen from this frame.
    #[must_use]
    pub fn relative(&self, other: &Self) -> Self {
        let seen = |vector: Vector| self.rotation.map(|axis| dot(axis, vector));
        Self { position: seen(minus(other.position, self.position, 1.0)), rotation: other.rotation.map(seen) }
    }

    /// Returns a vector of this frame in the outer frame.
    pub fn turn(&self, [x, y, z]: [f64; 3]) -> [f64; 3] {
        let [ahead, left, up] = self.rotation;
        std::array::from_fn(|row| x * ahead[row] + y * left[row] + z * up[row])
    }

    /// Returns the yaw: the heading of the x axis, in radians.
    pub fn yaw(&self) -> f64 {
        arctangent2(self.rotation[0][1], self.rotation[0][0])
    }

    /// Returns the angle in radians between the rotations of two poses.
    pub fn angle_to(&self, other: &Self) -> f64 {
        let trace: f64 = self.rotation.iter().zip(&other.rotation).map(|(one, two)| dot(*one, *two)).sum();
        arccosine((trace - 1.0) / 2.0)
    }

    /// Returns the rotation a `share` of the way to that of `other`, on the shortest arc (Shoemake, Animating rotation with
    /// quaternion curves, 1985).
    #[must_use]
    pub fn rotation_towards(&self, other: &Self, share: f64) -> [[f64; 3]; 3] {
        let (from, mut to) = (self.quaternion(), other.quaternion());
        let mut cosine: f64 = from.iter().zip(&to).map(|(one, two)| one * two).sum();
        if cosine < 0.0 {
            (to, cosine) = (to.map(|part| -part), -cosine);
        }
        let angle = arccosine(cosine);
        let sine = |angle| sine_cosine(angle).0;
        let [first, second] = match angle < 1e-6 {
            true => [1.0 - share, share],
            false => [sine((1.0 - share) * angle) / sine(angle), sine(share * angle) / sine(angle)],
        };
        let mixed: [f64; 4] = std::array::from_fn(|at| first * from[at] + second * to[at]);
        let size = mixed.iter().map(|part| part * part).sum::<f64>().sqrt();
        axes(mixed.map(|part| part / size))
    }
}
