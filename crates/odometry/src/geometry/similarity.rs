//! Alignment of points.

use super::eigen::eigen;
use super::pose::{Pose, times};
use super::vector::{Vector, dot, minus, plus, scaled};

/// A rigid motion with a scale (Sim(3)): `scale * rotation * point + position`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Similarity3 {
    /// Scale.
    pub scale: f64,
    /// Rotation and position.
    pub pose: Pose,
}

impl Similarity3 {
    /// Returns the motion, with scale or without, that maps `from` to `to` with the least squared distance: the rotation by B. K. P.
    /// Horn (Closed-form solution of absolute orientation using unit quaternions, 1987), scale and translation by S. Umeyama
    /// (Least-squares estimation of transformation parameters between two point patterns, 1991).
    ///
    /// `None` without three points, and with a scale for points that coincide. On a line the rotation about it is arbitrary.
    pub fn aligning(from: &[[f64; 3]], to: &[[f64; 3]], with_scale: bool) -> Option<Self> {
        let count = from.len();
        if count < 3 || count != to.len() {
            return None;
        }
        let middle =
            |points: &[Vector]| scaled(points.iter().copied().fold([0.0; 3], plus), 1.0 / count as f64);
        let (from_middle, to_middle) = (middle(from), middle(to));
        let (mut moments, mut spread) = ([[0.0; 3]; 3], 0.0);
        for (a, b) in from.iter().zip(to) {
            let (a, b) = (minus(*a, from_middle), minus(*b, to_middle));
            spread += dot(a, a);
            for (row, sums) in moments.iter_mut().enumerate() {
                (0..3).for_each(|column| sums[column] += a[row] * b[column]);
            }
        }
        let [[xx, xy, xz], [yx, yy, yz], [zx, zy, zz]] = moments;
        let symmetric = [
            [xx + yy + zz, yz - zy, zx - xz, xy - yx],
            [yz - zy, xx - yy - zz, xy + yx, zx + xz],
            [zx - xz, xy + yx, yy - xx - zz, yz + zy],
            [xy - yx, zx + xz, yz + zy, zz - xx - yy],
        ];
        let (values, vectors) = eigen(symmetric);
        let largest = (1..4).fold(0, |best, at| if values[at] > values[best] { at } else { best });
        let [w, x, y, z] = vectors[largest];
        let rotation = Pose::from_quaternion([0.0; 3], [x, y, z, w]).rotation;
        let scale = if with_scale {
            let trace: f64 = from
                .iter()
                .zip(to)
                .map(|(a, b)| dot(minus(*b, to_middle), times(&rotation, minus(*a, from_middle))))
                .sum();
            trace / spread
        } else {
            1.0
        };
        let position = minus(to_middle, scaled(times(&rotation, from_middle), scale));
        let is_finite = scale.is_finite() && scale > 0.0;
        is_finite
            .then_some(Self { scale, pose: Pose { rotation, position } })
            .filter(|found| found.pose.is_finite())
    }

    /// Returns the image of a point.
    pub fn point(&self, point: [f64; 3]) -> [f64; 3] {
        plus(scaled(times(&self.pose.rotation, point), self.scale), self.pose.position)
    }
}
