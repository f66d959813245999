//! Relative pose of two views of one camera.

use opendr_engine::Random;

use super::cholesky::solve_in_place;
use super::pose::{Pose, exponential, product, times};
use super::triangulation::triangulate;
use super::vector::{Vector, cross, dot, length, minus, plus, scaled, skew, unit};

/// Rays, with z = 1, of one point in two views.
pub(crate) type TwoViews = [Vector; 2];

/// Finds the pose of the second view in the first, with a translation of length 1, that most pairs agree with within `threshold`
/// (a tangent); `guess` starts each search. Writes which pairs agree; returns `None` when fewer than `least` do.
///
/// RANSAC over five pairs. A minimal set is solved by Gauss-Newton over the five parameters of the essential matrix from a few
/// starting motions (T. Botterill, S. Mills and R. Green, Fast RANSAC hypothesis generation for essential matrix estimation, 2011), which
/// unlike the eight points needs no scene of different depths.
pub(crate) fn relative_pose(
    pairs: &[TwoViews],
    threshold: f64,
    least: usize,
    random: &mut Random,
    agrees: &mut Vec<bool>,
) -> Option<Pose> {
    const TRIALS: usize = 150;
    if pairs.len() < least.max(8) {
        return None;
    }
    let starts = [[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]];
    let agree = |pose: &Pose| pairs.iter().filter(|pair| sampson(pose, pair) < threshold).count();
    let (mut best, mut most, mut best_score) = (None, 0, 0.0);
    for trial in 0..TRIALS {
        if most > 0 && trial > 20 && trial > 5 * super::resection::trials_for(most, pairs.len()) {
            break;
        }
        let chosen = [(); 5].map(|()| pairs[random.below(pairs.len())]);
        let start = Pose { position: starts[trial % starts.len()], ..Pose::IDENTITY };
        let Some(pose) = minimised(start, &chosen, f64::INFINITY) else { continue };
        let inliers = agree(&pose);
        // Of the two motions that a plane allows, cameras make the one that turns less.
        let score = inliers as f64 * (1.0 - 0.3 * pose.angle());
        if score > best_score {
            (best, most, best_score) = (Some(pose), inliers, score);
        }
    }
    let mut pose = best?;
    for _ in 0..3 {
        pose = minimised(pose, pairs, threshold)?;
    }
    // Of the two directions of the translation, points lie ahead of both views with one.
    let backwards = Pose { position: scaled(pose.position, -1.0), ..pose };
    let ahead = |pose: &Pose| {
        let is_ahead =
            |pair: &&TwoViews| triangulate([(&Pose::IDENTITY, pair[0]), (pose, pair[1])]).is_some();
        pairs.iter().filter(|pair| sampson(pose, pair) < threshold).filter(is_ahead).count()
    };
    if ahead(&backwards) > ahead(&pose) {
        pose = backwards;
    }
    agrees.clear();
    agrees.extend(pairs.iter().map(|pair| {
        sampson(&pose, pair) < threshold
            && triangulate([(&Pose::IDENTITY, pair[0]), (&pose, pair[1])]).is_some()
    }));
    (agrees.iter().filter(|agrees| **agrees).count() >= least).then_some(pose)
}

/// Returns the distance from the epipolar constraint, to first order (Sampson).
fn sampson(pose: &Pose, [first, second]: &TwoViews) -> f64 {
    let (value, normals) = constraint(pose, *first, *second);
    let size = normals.iter().map(|normal| normal[0] * normal[0] + normal[1] * normal[1]).sum::<f64>();
    value.abs() / size.sqrt().max(1e-12)
}

/// Returns first' [t]x R second, and its derivatives by the two rays.
fn constraint(pose: &Pose, first: Vector, second: Vector) -> (f64, [Vector; 2]) {
    let rotated = times(&pose.rotation, second);
    let by_first = cross(pose.position, rotated);
    let back = cross(first, pose.position);
    let by_second: Vector =
        std::array::from_fn(|column| (0..3).map(|row| pose.rotation[row][column] * back[row]).sum());
    (dot(first, by_first), [by_first, by_second])
}

/// Minimises the epipolar distances, with Huber's weights beyond `threshold`.
fn minimised(mut pose: Pose, pairs: &[TwoViews], threshold: f64) -> Option<Pose> {
    for _ in 0..12 {
        let aside = unit(perpendicular(pose.position));
        let axes = [aside, cross(pose.position, aside)];
        let (mut normal, mut gradient) = ([[0.0; 5]; 5], [0.0; 5]);
        for [first, second] in pairs {
            let (value, normals) = constraint(&pose, *first, *second);
            let size = normals.iter().map(|part| part[0] * part[0] + part[1] * part[1]).sum::<f64>().sqrt();
            let residual = value / size.max(1e-12);
            let weight = if residual.abs() > threshold { threshold / residual.abs() } else { 1.0 };
            let weight = if residual.abs() > 4.0 * threshold { 0.0 } else { weight };
            let rotated = times(&pose.rotation, *second);
            let back = cross(*first, pose.position);
            // A rotation w of the second view moves its ray by w x rotated.
            let by_rotation = cross(rotated, back);
            let by_shift = cross(rotated, *first);
            let slopes = [
                by_rotation[0],
                by_rotation[1],
                by_rotation[2],
                dot(by_shift, axes[0]),
                dot(by_shift, axes[1]),
            ]
            .map(|part| part / size.max(1e-12));
            for row in 0..5 {
                gradient[row] += weight * slopes[row] * residual;
                (0..=row).for_each(|column| normal[row][column] += weight * slopes[row] * slopes[column]);
            }
        }
        (0..5).for_each(|at| normal[at][at] += 1e-9 + 1e-6 * normal[at][at]);
        let mut step = gradient.map(|part| -part);
        if !solve_in_place(normal.as_flattened_mut(), &mut step) {
            return None;
        }
        let [a, b, c, x, y] = step.map(|part| part.clamp(-0.5, 0.5));
        pose.rotation = product(&exponential([a, b, c]), &pose.rotation);
        pose.position = unit(plus(pose.position, plus(scaled(axes[0], x), scaled(axes[1], y))));
        if step.iter().all(|part| part.abs() < 1e-9) {
            break;
        }
    }
    let is_turned = length(minus(times(&pose.rotation, [0.0, 0.0, 1.0]), [0.0, 0.0, 1.0])) < 1.0;
    (pose.is_finite() && is_turned).then_some(pose)
}

/// Returns a vector across another: its cross product with the axis from which it differs most.
fn perpendicular(vector: Vector) -> Vector {
    let smallest = (1..3).fold(0, |best, at| if vector[at].abs() < vector[best].abs() { at } else { best });
    skew(vector).map(|row| row[smallest])
}
