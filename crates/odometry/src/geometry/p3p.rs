//! Pose of a camera from three points.

use super::polynomial::real_roots;
use super::pose::Pose;
use super::similarity::Similarity3;
use super::vector::{Vector, distance, dot, scaled};

/// Writes the poses world_from_camera in which the three world points lie on the three unit rays, and returns their number.
///
/// Grunert's solution (1841) as in Haralick et al., Review and analysis of solutions of the three point perspective pose estimation
/// problem, 1994; the pose follows from the distances by Horn's alignment.
pub(super) fn p3p(points: &[Vector; 3], rays: &[Vector; 3], poses: &mut [Pose; 4]) -> usize {
    let [a, b, c] =
        [distance(points[1], points[2]), distance(points[0], points[2]), distance(points[0], points[1])];
    let [alpha, beta, gamma] = [dot(rays[1], rays[2]), dot(rays[0], rays[2]), dot(rays[0], rays[1])];
    if a.min(b).min(c) < 1e-9 {
        return 0;
    }
    let [a2, b2, c2] = [a * a, b * b, c * c];
    let (p, q, r) = ((a2 - c2) / b2, (a2 + c2) / b2, (b2 - c2) / b2);
    let s = (b2 - a2) / b2;
    let coefficients = [
        (p - 1.0).powi(2) - 4.0 * c2 / b2 * alpha * alpha,
        4.0 * (p * (1.0 - p) * beta - (1.0 - q) * alpha * gamma + 2.0 * c2 / b2 * alpha * alpha * beta),
        2.0 * (p * p - 1.0 + 2.0 * p * p * beta * beta + 2.0 * r * alpha * alpha
            - 4.0 * q * alpha * beta * gamma
            + 2.0 * s * gamma * gamma),
        4.0 * (-p * (1.0 + p) * beta + 2.0 * a2 / b2 * gamma * gamma * beta - (1.0 - q) * alpha * gamma),
        (1.0 + p).powi(2) - 4.0 * a2 / b2 * gamma * gamma,
    ];
    let mut roots = [0.0; 4];
    let count = real_roots(&coefficients, &mut roots);
    let mut found = 0;
    for v in roots.into_iter().take(count).filter(|v| *v > 0.0) {
        let divisor = 2.0 * (gamma - v * alpha);
        if divisor.abs() < 1e-12 {
            continue;
        }
        let u = ((p - 1.0) * v * v - 2.0 * p * beta * v + 1.0 + p) / divisor;
        let square = b2 / (1.0 + v * v - 2.0 * v * beta);
        if u <= 0.0 || square.is_nan() || square <= 0.0 {
            continue;
        }
        let first = square.sqrt();
        let in_camera = [scaled(rays[0], first), scaled(rays[1], u * first), scaled(rays[2], v * first)];
        if let Some(aligned) = Similarity3::aligning(&in_camera, points, false) {
            poses[found] = aligned.pose;
            found += 1;
        }
    }
    found
}
