//! Refinement of a camera's pose by Gauss-Newton on SE(3).

use super::camera::PinholeCamera;
use super::cholesky::solve_in_place;
use super::pose::{Pose, exponential, orthonormal, product};
use super::vector::{Vector, plus};

/// A world point with its pixel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Sight {
    pub point: Vector,
    pub pixel: [f64; 2],
}

/// Minimises the reprojection errors of `sights` from a pose world_from_camera, with Huber's weights beyond `threshold` pixels.
/// Sights farther off than three thresholds have no weight. Returns `None` for fewer than four such sights, or when they do not
/// determine a pose.
pub(crate) fn refine_pose(
    camera: &PinholeCamera,
    mut pose: Pose,
    sights: impl Iterator<Item = Sight> + Clone,
    threshold: f64,
) -> Option<Pose> {
    for _ in 0..10 {
        let (mut normal, mut gradient, mut used) = ([[0.0; 6]; 6], [0.0; 6], 0);
        for sight in sights.clone() {
            let point = pose.point_in_frame(sight.point);
            let Some(pixel) = camera.project(point) else { continue };
            let residual = [pixel[0] - sight.pixel[0], pixel[1] - sight.pixel[1]];
            let error = residual[0].hypot(residual[1]);
            if error > 3.0 * threshold {
                continue;
            }
            used += 1;
            let weight = if error > threshold { threshold / error } else { 1.0 };
            for (slopes, residual) in projection_slopes(camera, point).into_iter().zip(residual) {
                let slopes = by_pose(slopes, point);
                for row in 0..6 {
                    gradient[row] += weight * slopes[row] * residual;
                    (0..=row).for_each(|column| normal[row][column] += weight * slopes[row] * slopes[column]);
                }
            }
        }
        if used < 4 {
            return None;
        }
        (0..6).for_each(|at| normal[at][at] *= 1.0 + 1e-9);
        let mut step = gradient.map(|part| -part);
        if !solve_in_place(normal.as_flattened_mut(), &mut step) {
            return None;
        }
        pose = moved(&pose, step);
        if step.iter().all(|part| part.abs() < 1e-7) {
            break;
        }
    }
    pose.is_finite().then_some(pose)
}

/// Returns the pose with the camera rotated by the first three numbers and moved by the last three, both in its own frame.
pub(crate) fn moved(pose: &Pose, step: [f64; 6]) -> Pose {
    let [a, b, c, x, y, z] = step;
    let rotation = orthonormal(product(&pose.rotation, &exponential([a, b, c])));
    let shift = pose.rotation.map(|row| row[0] * x + row[1] * y + row[2] * z);
    Pose { rotation, position: plus(pose.position, shift) }
}

/// Returns the derivatives of the pixel of a point in the camera's frame by the point.
pub(crate) fn projection_slopes(camera: &PinholeCamera, [x, y, z]: Vector) -> [Vector; 2] {
    let [fx, fy] = camera.focal_length;
    [[fx / z, 0.0, -fx * x / (z * z)], [0.0, fy / z, -fy * y / (z * z)]]
}

/// Returns derivatives by the step of [`moved`] of what has derivatives `[a, b, c]` by the point in the camera's frame: the point moves by
/// point x rotation - shift.
pub(crate) fn by_pose([a, b, c]: Vector, [x, y, z]: Vector) -> [f64; 6] {
    [b * z - c * y, c * x - a * z, a * y - b * x, -a, -b, -c]
}
