//! Disparities of single corners.

use super::flow::follow;
use super::pyramid::Pyramid;

/// Half side of the compared windows on the level of half the size.
const HALF: usize = 4;
/// Part of the second best sum of differences that the best must stay below.
const DISTINCT: f32 = 0.8;

/// Returns the disparity in pixels of a corner of the left image of a rectified pair, at most `most`: block matching along the row at half
/// the size, refined and checked back by the optical flow. `None` where it is not clear.
pub(crate) fn find_disparity(left: &Pyramid, right: &Pyramid, corner: [f32; 2], most: usize) -> Option<f32> {
    let [one, other] = [left, right].map(|pyramid| &pyramid.levels()[1]);
    let [x, y] = corner.map(|at| ((at + 0.5) / 2.0 - 0.5).round().max(0.0) as usize);
    let fits = x >= HALF && y >= HALF && x + HALF < one.width && y + HALF < one.height;
    if !fits {
        return None;
    }
    let row = |level: &super::pyramid::Level, y: usize, x: usize| {
        (y * level.width + x - HALF)..(y * level.width + x + HALF + 1)
    };
    let cost = |shift: usize| {
        let mut lanes = [0.0_f32; 2 * HALF + 1];
        for at in y - HALF..=y + HALF {
            let (own, its) = (&one.luminance[row(one, at, x)], &other.luminance[row(other, at, x - shift)]);
            for lane in 0..=2 * HALF {
                lanes[lane] += (own[lane] - its[lane]).abs();
            }
        }
        lanes.iter().sum::<f32>()
    };
    let last = (most / 2).min(x - HALF);
    let (mut best, mut second) = ((f32::INFINITY, 0), f32::INFINITY);
    for shift in 0..=last {
        let cost = cost(shift);
        if cost < best.0 {
            if shift > best.1 + 1 {
                second = second.min(best.0);
            }
            best = (cost, shift);
        } else if shift > best.1 + 1 {
            second = second.min(cost);
        }
    }
    if best.0 > DISTINCT * second {
        return None;
    }
    let guess = [corner[0] - 2.0 * best.1 as f32, corner[1]];
    refined_disparity(left, right, corner, guess)
}

/// Returns the disparity of a corner near a guess of its place in the right image.
fn refined_disparity(left: &Pyramid, right: &Pyramid, corner: [f32; 2], guess: [f32; 2]) -> Option<f32> {
    let found = follow(left, right, corner, guess, 1)?;
    let back = follow(right, left, found.place, corner, 0)?;
    let is_same = (back.place[0] - corner[0]).abs() < 0.5 && (back.place[1] - corner[1]).abs() < 0.5;
    let is_level = (found.place[1] - corner[1]).abs() < 1.0;
    let disparity = corner[0] - found.place[0];
    (is_same && is_level && disparity > 0.2).then_some(disparity)
}
