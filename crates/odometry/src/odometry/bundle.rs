//! Refinement of a window of key frames with their landmarks.

use super::landmark::{Landmark, Observation};
use crate::geometry::{PinholeCamera, Pose, Vector, by_pose, moved, plus, projection_slopes, solve_in_place};

/// A key frame of the window.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct WindowFrame {
    pub key: u32,
    pub pose: Pose,
}

/// Memory of bundle adjustment: Levenberg and Marquardt's method with the landmarks eliminated by the Schur complement (B. Triggs et al.,
/// Bundle adjustment: a modern synthesis, 2000).
#[derive(Debug, Default)]
pub(super) struct Bundle {
    normal: Vec<f64>,
    right: Vec<f64>,
    poses: Vec<WindowFrame>,
    points: Vec<Vector>,
    used: Vec<usize>,
}

/// Residual beyond which weights fall, in pixels.
const HUBER: f64 = 1.2;
const ITERATIONS: usize = 5;

type Slopes6 = [[f64; 6]; 3];
type Slopes3 = [[f64; 3]; 3];

/// Residual of an observation with its derivatives; the third row is the column in the right image.
struct Linear {
    residual: [f64; 3],
    by_pose: Slopes6,
    by_point: Slopes3,
    weight: f64,
}

/// The normal equations of one landmark.
struct Own {
    normal: [[f64; 3]; 3],
    right: Vector,
}

impl Bundle {
    /// Refines the poses of `frames` but the first `fixed`, and the points of landmarks that two of them saw.
    pub fn refine(
        &mut self,
        camera: &PinholeCamera,
        frames: &mut [WindowFrame],
        landmarks: &mut [Landmark],
        fixed: usize,
    ) {
        let oldest = frames.first().map_or(0, |frame| frame.key);
        self.used.clear();
        self.used.extend(
            landmarks
                .iter()
                .enumerate()
                .filter(|(_, landmark)| {
                    landmark.point.is_some()
                        && landmark.seen().iter().filter(|seen| seen.key >= oldest).count() >= 2
                })
                .map(|(at, _)| at),
        );
        if frames.len() <= fixed || self.used.len() < 10 {
            return;
        }
        let mut damping = 1e-4;
        let mut cost = self.cost(camera, frames, landmarks, |_, landmark| landmark.point);
        for _ in 0..ITERATIONS {
            let size = 6 * (frames.len() - fixed);
            self.normal.clear();
            self.normal.resize(size * size, 0.0);
            self.right.clear();
            self.right.resize(size, 0.0);
            self.eliminate(camera, frames, landmarks, fixed, damping);
            for at in 0..size {
                self.normal[at * size + at] *= 1.0 + damping;
                self.normal[at * size + at] += 1e-6;
            }
            if !solve_in_place(&mut self.normal, &mut self.right) {
                damping *= 10.0;
                continue;
            }
            self.substitute(camera, frames, landmarks, fixed, damping);
            let moved = std::mem::take(&mut self.points);
            let trial = std::mem::take(&mut self.poses);
            let next = self.cost(camera, &trial, landmarks, |at, _| moved.get(at).copied());
            let is_better = next < cost;
            if is_better {
                frames.copy_from_slice(&trial);
                for (at, point) in self.used.iter().zip(&moved) {
                    landmarks[*at].point = Some(*point);
                }
            }
            (self.points, self.poses) = (moved, trial);
            if !is_better {
                damping *= 10.0;
                continue;
            }
            let gain = cost - next;
            (cost, damping) = (next, damping * 0.2);
            if gain < 1e-3 * cost {
                break;
            }
        }
    }

    fn cost(
        &self,
        camera: &PinholeCamera,
        frames: &[WindowFrame],
        landmarks: &[Landmark],
        point: impl Fn(usize, &Landmark) -> Option<Vector>,
    ) -> f64 {
        let mut cost = 0.0;
        for (number, at) in self.used.iter().enumerate() {
            let landmark = &landmarks[*at];
            let Some(point) = point(number, landmark) else { continue };
            for (frame, seen) in matched(frames, landmark.seen()) {
                let error = residual(camera, &frames[frame].pose, point, seen)
                    .map_or(400.0, |[x, y, z]| (x * x + y * y + z * z).sqrt());
                cost += if error > HUBER { HUBER * (2.0 * error - HUBER) } else { error * error };
            }
        }
        cost
    }

    /// Accumulates the equations of the poses.
    fn eliminate(
        &mut self,
        camera: &PinholeCamera,
        frames: &[WindowFrame],
        landmarks: &[Landmark],
        fixed: usize,
        damping: f64,
    ) {
        let size = self.right.len();
        for at in &self.used {
            let landmark = &landmarks[*at];
            let Some(point) = landmark.point else { continue };
            let mut own = Own { normal: [[0.0; 3]; 3], right: [0.0; 3] };
            // Products of poses and the point, for each frame that saw it.
            let mut crossed = [[[0.0; 3]; 6]; super::landmark::MOST];
            let mut rows = [usize::MAX; super::landmark::MOST];
            let mut count = 0;
            for (frame, seen) in matched(frames, landmark.seen()) {
                let Some(linear) = linearised(camera, &frames[frame].pose, point, seen) else { continue };
                own.add(&linear);
                if frame < fixed || count == rows.len() {
                    continue;
                }
                let begin = 6 * (frame - fixed);
                for (row, crossed) in crossed[count].iter_mut().enumerate() {
                    let product = |other: &dyn Fn(usize) -> f64| -> f64 {
                        (0..3).map(|part| linear.weight * linear.by_pose[part][row] * other(part)).sum()
                    };
                    self.right[begin + row] -= product(&|part| linear.residual[part]);
                    for column in 0..=row {
                        self.normal[(begin + row) * size + begin + column] +=
                            product(&|part| linear.by_pose[part][column]);
                    }
                    *crossed = std::array::from_fn(|column| product(&|part| linear.by_point[part][column]));
                }
                rows[count] = begin;
                count += 1;
            }
            let Some(inverse) = own.inverse(damping) else { continue };
            for one in 0..count {
                let times: [[f64; 3]; 6] = crossed[one].map(|row| {
                    std::array::from_fn(|column| (0..3).map(|part| row[part] * inverse[part][column]).sum())
                });
                for (row, times) in times.iter().enumerate() {
                    let at = rows[one] + row;
                    self.right[at] -= (0..3).map(|part| times[part] * own.right[part]).sum::<f64>();
                    for (begin, crossed) in rows.iter().zip(&crossed).take(one + 1) {
                        for (column, crossed) in crossed.iter().enumerate() {
                            let product: f64 = (0..3).map(|part| times[part] * crossed[part]).sum();
                            self.normal[at * size + begin + column] -= product;
                        }
                    }
                }
            }
        }
    }

    /// Computes the moved poses and points from the solved equations.
    fn substitute(
        &mut self,
        camera: &PinholeCamera,
        frames: &[WindowFrame],
        landmarks: &[Landmark],
        fixed: usize,
        damping: f64,
    ) {
        self.poses.clear();
        for (number, frame) in frames.iter().enumerate() {
            let mut pose = frame.pose;
            if number >= fixed {
                let at = 6 * (number - fixed);
                pose = moved(&pose, std::array::from_fn(|part| self.right[at + part]));
            }
            self.poses.push(WindowFrame { pose, ..*frame });
        }
        self.points.clear();
        for at in &self.used {
            let landmark = &landmarks[*at];
            let Some(point) = landmark.point else { continue };
            let mut own = Own { normal: [[0.0; 3]; 3], right: [0.0; 3] };
            for (frame, seen) in matched(frames, landmark.seen()) {
                let Some(linear) = linearised(camera, &frames[frame].pose, point, seen) else { continue };
                own.add(&linear);
                if frame < fixed {
                    continue;
                }
                let step = &self.right[6 * (frame - fixed)..][..6];
                for part in 0..3 {
                    let by_pose: f64 = (0..6).map(|row| linear.by_pose[part][row] * step[row]).sum();
                    for column in 0..3 {
                        own.right[column] -= linear.weight * linear.by_point[part][column] * by_pose;
                    }
                }
            }
            let shift = own.inverse(damping).map_or([0.0; 3], |inverse| {
                inverse.map(|row| (0..3).map(|part| row[part] * own.right[part]).sum())
            });
            self.points.push(plus(point, shift));
        }
    }
}

impl Own {
    fn add(&mut self, linear: &Linear) {
        for part in 0..3 {
            let slopes = linear.by_point[part];
            for row in 0..3 {
                self.right[row] -= linear.weight * slopes[row] * linear.residual[part];
                (0..3).for_each(|column| {
                    self.normal[row][column] += linear.weight * slopes[row] * slopes[column]
                });
            }
        }
    }

    fn inverse(&self, damping: f64) -> Option<[[f64; 3]; 3]> {
        let mut m = self.normal;
        (0..3).for_each(|at| m[at][at] += damping * m[at][at] + 1e-9);
        let minor =
            |r: [usize; 2], c: [usize; 2]| m[r[0]][c[0]] * m[r[1]][c[1]] - m[r[0]][c[1]] * m[r[1]][c[0]];
        let cofactors = [
            [minor([1, 2], [1, 2]), -minor([0, 2], [1, 2]), minor([0, 1], [1, 2])],
            [-minor([1, 2], [0, 2]), minor([0, 2], [0, 2]), -minor([0, 1], [0, 2])],
            [minor([1, 2], [0, 1]), -minor([0, 2], [0, 1]), minor([0, 1], [0, 1])],
        ];
        let determinant = m[0][0] * cofactors[0][0] + m[0][1] * cofactors[1][0] + m[0][2] * cofactors[2][0];
        (determinant > 0.0).then(|| cofactors.map(|row| row.map(|part| part / determinant)))
    }
}

/// Returns the frames of the window with the observations of theirs.
fn matched<'a>(
    frames: &'a [WindowFrame],
    seen: &'a [Observation],
) -> impl Iterator<Item = (usize, &'a Observation)> {
    seen.iter().filter_map(|seen| Some((frames.iter().position(|frame| frame.key == seen.key)?, seen)))
}

/// Returns the error in pixels: column, row, and column in the right image; `None` behind the camera.
pub(super) fn residual(
    camera: &PinholeCamera,
    pose: &Pose,
    point: Vector,
    seen: &Observation,
) -> Option<[f64; 3]> {
    let point = pose.point_in_frame(point);
    let [u, v] = camera.project(point)?;
    let [x, y] = seen.pixel.map(f64::from);
    let right =
        if seen.right.is_nan() { 0.0 } else { u - camera.disparity(point[2]) - f64::from(seen.right) };
    Some([u - x, v - y, right])
}

fn linearised(camera: &PinholeCamera, pose: &Pose, point: Vector, seen: &Observation) -> Option<Linear> {
    let residual = residual(camera, pose, point, seen)?;
    let in_camera = pose.point_in_frame(point);
    let [by_column @ [a, _, c], by_row] = projection_slopes(camera, in_camera);
    let depth = in_camera[2];
    let by_right = if seen.right.is_nan() { [0.0; 3] } else { [a, 0.0, c + camera.disparity(depth) / depth] };
    let by_camera_point = [by_column, by_row, by_right];
    let error = residual.iter().map(|part| part * part).sum::<f64>().sqrt();
    Some(Linear {
        residual,
        by_pose: by_camera_point.map(|slopes| by_pose(slopes, in_camera)),
        by_point: by_camera_point.map(|row| {
            std::array::from_fn(|axis| (0..3).map(|part| row[part] * pose.rotation[axis][part]).sum())
        }),
        weight: if error > HUBER { HUBER / error } else { 1.0 },
    })
}
