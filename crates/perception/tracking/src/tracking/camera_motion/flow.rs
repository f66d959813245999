//! Sparse optical flow of points between two frames.

use super::pyramid::{Plane, Pyramid};

/// Pixels to each side of a point in its window.
const REACH: i32 = 4;
const COUNT: usize = ((2 * REACH + 1) * (2 * REACH + 1)) as usize;
const STEPS: usize = 12;
/// Step length below which the iteration ends, in pixels.
const SHORT: f32 = 0.02;
/// Determinant of the gradients' covariance below which a point cannot be tracked.
const FLAT: f32 = 1.0;
/// Mean difference of levels above which a match is rejected.
const DIFFERENT: f32 = 16.0;

/// Returns the position of `point` in `now`, both in pixels of the largest level; `None` when it left the image or changed.
pub(super) fn follow(before: &Pyramid, now: &Pyramid, point: [f32; 2]) -> Option<[f32; 2]> {
    let mut moved = [0.0; 2];
    for (level, (before, now)) in before.planes.iter().zip(&now.planes).enumerate().rev() {
        let scale = 1.0 / (1 << level) as f32;
        // Pixel centres of a smaller level lie between those of a larger one.
        let here = point.map(|at| (at + 0.5) * scale - 0.5);
        let start = moved.map(|by| by * scale);
        match step(before, now, here, start) {
            Some((found, difference)) => {
                if level == 0 && difference > DIFFERENT {
                    return None;
                }
                moved = found.map(|by| by / scale);
            }
            // Smaller levels only improve the start.
            None if level > 0 => {}
            None => return None,
        }
    }
    Some([point[0] + moved[0], point[1] + moved[1]])
}

/// Returns the motion at one level, from a first guess, and the remaining mean difference of levels.
fn step(before: &Plane, now: &Plane, [x, y]: [f32; 2], guess: [f32; 2]) -> Option<([f32; 2], f32)> {
    let mut patch = [[0.0; 3]; COUNT];
    let mut sums = [0.0; 3];
    for (cell, [across, down]) in patch.iter_mut().zip(offsets()) {
        let (x, y) = (x + across, y + down);
        let slope_x = (before.at(x + 1.0, y)? - before.at(x - 1.0, y)?) * 0.5;
        let slope_y = (before.at(x, y + 1.0)? - before.at(x, y - 1.0)?) * 0.5;
        *cell = [before.at(x, y)?, slope_x, slope_y];
        sums = [sums[0] + slope_x * slope_x, sums[1] + slope_x * slope_y, sums[2] + slope_y * slope_y];
    }
    let determinant = sums[0] * sums[2] - sums[1] * sums[1];
    if determinant < FLAT {
        return None;
    }
    let (mut moved, mut difference) = (guess, f32::INFINITY);
    for _ in 0..STEPS {
        let (mut pull, mut total) = ([0.0; 2], 0.0);
        for ([level, slope_x, slope_y], [across, down]) in patch.iter().zip(offsets()) {
            let left = level - now.at(x + across + moved[0], y + down + moved[1])?;
            pull = [pull[0] + left * slope_x, pull[1] + left * slope_y];
            total += left.abs();
        }
        difference = total / COUNT as f32;
        let by = [
            (sums[2] * pull[0] - sums[1] * pull[1]) / determinant,
            (sums[0] * pull[1] - sums[1] * pull[0]) / determinant,
        ];
        moved = [moved[0] + by[0], moved[1] + by[1]];
        if by[0].hypot(by[1]) < SHORT {
            break;
        }
    }
    moved.iter().all(|by| by.is_finite()).then_some((moved, difference))
}

fn offsets() -> impl Iterator<Item = [f32; 2]> {
    (-REACH..=REACH).flat_map(|down| (-REACH..=REACH).map(move |across| [across as f32, down as f32]))
}
