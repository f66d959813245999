//! Motion of image patches: the inverse compositional form of Lucas and Kanade's method on pyramids.
//!
//! S. Baker and I. Matthews, Lucas-Kanade 20 years on, 2004; J.-Y. Bouguet, Pyramidal implementation of the affine Lucas Kanade feature
//! tracker, 2001. Gradients without their mean make it independent of the brightness of a patch.

use super::pyramid::{Level, Pyramid};

/// Half side of a patch.
const HALF: usize = 7;
const SIDE: usize = 2 * HALF + 1;
/// Numbers of a row with padding: whole vector registers.
const PADDED: usize = 16;
const STEPS: usize = 12;

/// Where a patch was found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Match {
    pub place: [f32; 2],
    /// Mean absolute difference of the patches without their brightness, in grey levels.
    pub difference: f32,
}

type Patch = [[f32; PADDED]; SIDE];

/// Returns where the patch around `place` of one image is in another, from a guess; `None` when it leaves the image, has no texture, or
/// the search does not converge. `coarsest` is the first level searched, 0 the image itself.
pub(crate) fn follow(
    from: &Pyramid,
    to: &Pyramid,
    place: [f32; 2],
    guess: [f32; 2],
    coarsest: usize,
) -> Option<Match> {
    #[cfg(target_arch = "x86_64")]
    if std::is_x86_feature_detected!("avx2") {
        // SAFETY: the CPU supports the features that the function is compiled for.
        return unsafe { follow_avx2(from, to, place, guess, coarsest) };
    }
    search(from, to, place, guess, coarsest)
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn follow_avx2(
    from: &Pyramid,
    to: &Pyramid,
    place: [f32; 2],
    guess: [f32; 2],
    coarsest: usize,
) -> Option<Match> {
    search(from, to, place, guess, coarsest)
}

/// Compiled into each caller, with the vectors that the caller has.
#[inline(always)]
fn search(from: &Pyramid, to: &Pyramid, place: [f32; 2], guess: [f32; 2], coarsest: usize) -> Option<Match> {
    let mut found = guess;
    let mut difference = f32::INFINITY;
    let levels = from.levels().iter().zip(to.levels()).enumerate();
    for (number, (one, other)) in levels.take(coarsest + 1).rev() {
        let scale = 1.0 / (1 << number) as f32;
        // Centres of pixels: that of a coarse pixel is between those of the finer.
        let onto = |at: [f32; 2]| at.map(|part| (part + 0.5) * scale - 0.5);
        let back = |at: [f32; 2]| at.map(|part| (part + 0.5) / scale - 0.5);
        match follow_on_level(one, other, onto(place), onto(found)) {
            Some((at, left)) => (found, difference) = (back(at), left),
            // Close to the border only finer levels have room.
            None if number > 0 => {}
            None => return None,
        }
    }
    difference.is_finite().then_some(Match { place: found, difference })
}

#[inline(always)]
fn follow_on_level(one: &Level, other: &Level, place: [f32; 2], guess: [f32; 2]) -> Option<([f32; 2], f32)> {
    let mut wide = [[0.0; PADDED + 2]; SIDE + 2];
    sample_wide(one, place, &mut wide)?;
    let (mut patch, mut by_x, mut by_y): (Patch, Patch, Patch) = Default::default();
    for y in 0..SIDE {
        for x in 0..SIDE {
            patch[y][x] = wide[y + 1][x + 1];
            by_x[y][x] = 0.5 * (wide[y + 1][x + 2] - wide[y + 1][x]);
            by_y[y][x] = 0.5 * (wide[y + 2][x + 1] - wide[y][x + 1]);
        }
    }
    let count = (SIDE * SIDE) as f32;
    let [mean_x, mean_y] = [sum(&by_x) / count, sum(&by_y) / count];
    for y in 0..SIDE {
        for x in 0..SIDE {
            by_x[y][x] -= mean_x;
            by_y[y][x] -= mean_y;
        }
    }
    let (a, b, c) = (product(&by_x, &by_x), product(&by_x, &by_y), product(&by_y, &by_y));
    let determinant = a * c - b * b;
    let smaller = 0.5 * (a + c - ((a - c) * (a - c) + 4.0 * b * b).sqrt());
    if smaller < 2.0 * count {
        return None;
    }
    let mut found = guess;
    let mut other_patch = Patch::default();
    let mut settled = false;
    for _ in 0..STEPS {
        sample(other, found, &mut other_patch)?;
        let (p, q) = (difference(&by_x, &other_patch, &patch), difference(&by_y, &other_patch, &patch));
        let step = [(c * p - b * q) / determinant, (a * q - b * p) / determinant];
        found = [found[0] - step[0], found[1] - step[1]];
        if step[0].abs().max(step[1].abs()) < 0.01 {
            settled = true;
            break;
        }
    }
    let aside = (found[0] - guess[0]).abs().max((found[1] - guess[1]).abs());
    if !settled && aside > HALF as f32 {
        return None;
    }
    sample(other, found, &mut other_patch)?;
    let brighter = (sum(&other_patch) - sum(&patch)) / count;
    let mut left = [0.0; PADDED];
    for (own, other) in patch.iter().zip(&other_patch) {
        for lane in 0..SIDE {
            left[lane] += (other[lane] - own[lane] - brighter).abs();
        }
    }
    Some((found, left.iter().sum::<f32>() / count))
}

/// Samples the patch with its neighbours on each side.
#[inline(always)]
fn sample_wide(level: &Level, place: [f32; 2], wide: &mut [[f32; PADDED + 2]; SIDE + 2]) -> Option<()> {
    let (begin, weights) = corner(level, place, HALF + 1, SIDE + 2)?;
    for (y, row) in wide.iter_mut().enumerate() {
        blend::<{ SIDE + 2 }>(level, begin + y * level.width, weights, row);
    }
    Some(())
}

#[inline(always)]
fn sample(level: &Level, place: [f32; 2], patch: &mut Patch) -> Option<()> {
    let (begin, weights) = corner(level, place, HALF, SIDE)?;
    for (y, row) in patch.iter_mut().enumerate() {
        blend::<SIDE>(level, begin + y * level.width, weights, row);
    }
    Some(())
}

/// Returns the offset of the first sample and the weights of the four pixels around each.
#[inline(always)]
fn corner(level: &Level, place: [f32; 2], half: usize, side: usize) -> Option<(usize, [f32; 4])> {
    let [x, y] = place.map(|at| at - half as f32);
    let is_inside = x >= 0.0
        && y >= 0.0
        && x + (side as f32) < level.width as f32
        && y + (side as f32) < level.height as f32;
    if !is_inside {
        return None;
    }
    let [column, row] = [x as usize, y as usize];
    let [u, v] = [x - column as f32, y - row as f32];
    let weights = [(1.0 - u) * (1.0 - v), u * (1.0 - v), (1.0 - u) * v, u * v];
    Some((row * level.width + column, weights))
}

#[inline(always)]
fn blend<const N: usize>(level: &Level, begin: usize, [a, b, c, d]: [f32; 4], row: &mut [f32]) {
    let (Some(above), Some(below)) = (
        level.luminance.get(begin..begin + N + 1),
        level.luminance.get(begin + level.width..begin + level.width + N + 1),
    ) else {
        return;
    };
    for x in 0..N {
        row[x] = a * above[x] + b * above[x + 1] + c * below[x] + d * below[x + 1];
    }
}

#[inline(always)]
fn sum(patch: &Patch) -> f32 {
    let mut lanes = [0.0; PADDED];
    for row in patch {
        (0..PADDED).for_each(|lane| lanes[lane] += row[lane]);
    }
    lanes.iter().sum()
}

#[inline(always)]
fn product(a: &Patch, b: &Patch) -> f32 {
    let mut lanes = [0.0; PADDED];
    for (a, b) in a.iter().zip(b) {
        (0..PADDED).for_each(|lane| lanes[lane] += a[lane] * b[lane]);
    }
    lanes.iter().sum()
}

/// Returns the product of slopes with the difference of two patches.
#[inline(always)]
fn difference(slopes: &Patch, one: &Patch, other: &Patch) -> f32 {
    let mut lanes = [0.0; PADDED];
    for ((slopes, one), other) in slopes.iter().zip(one).zip(other) {
        (0..PADDED).for_each(|lane| lanes[lane] += slopes[lane] * (one[lane] - other[lane]));
    }
    lanes.iter().sum()
}
