//! Disparities of a stereo pair by semi-global matching.
//!
//! H. Hirschmüller, "Stereo processing by semiglobal matching and mutual information", IEEE PAMI 2008, over census
//! costs (9 x 7, Zabih and Woodfill 1994). Eight paths in two passes: one goes down the image, the other up, each on
//! a thread. They meet in the middle, and from there each decides the rows that the other has already processed, so
//! that one table of sums is enough and the threads do not affect the result. Costs and paths are bytes, sums 16
//! bits, 2 bytes for each pixel and disparity.

mod brightness;
mod bytes;
mod camera;
mod census;
mod paths;
mod repair;
mod winner;

use std::sync::{Mutex, MutexGuard, PoisonError};

use opendr_engine::data::Image;
use opendr_engine::{Error, Result};

use crate::components::Components;
use crate::workers;

pub use camera::StereoCamera;

use brightness::Brightness;
use bytes::Bytes;
use census::Census;
use paths::{MOST_PENALTY, Pass, Penalties};
use winner::{ConfidenceChecks, UNKNOWN, Winner};

/// Options of stereo matching.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StereoOptions {
    /// Minimum disparity, in pixels.
    pub min_disparity: usize,
    /// Number of disparities to search; rounded up to a multiple of 16.
    pub disparities: usize,
    /// Penalty P1 for a disparity change of one pixel, in differing bits of 62.
    pub p1: u8,
    /// Penalty P2 for a larger change; at least P1, at most 193.
    pub p2: u8,
    /// Margin in percent by which the second best disparity must be worse, 0..=99.
    pub uniqueness: u8,
    /// Maximum difference to the right image's disparity, in pixels; `None` skips the check.
    pub max_left_right_difference: Option<u16>,
    /// Maximum size in pixels of speckles that are removed; 0 keeps all.
    pub speckle_size: u32,
    /// Maximum difference between neighbours of one speckle, in pixels.
    pub speckle_range: f32,
    /// Whether unknown disparities are filled from the row's background.
    pub fill: bool,
    /// Side of the blocks of pixels that are matched as one; the time falls with its third power; at least 1.
    pub downscale: usize,
}

impl Default for StereoOptions {
    fn default() -> Self {
        Self {
            min_disparity: 0,
            disparities: 64,
            p1: 8,
            p2: 40,
            uniqueness: 5,
            max_left_right_difference: Some(1),
            speckle_size: 100,
            speckle_range: 1.0,
            fill: false,
            downscale: 1,
        }
    }
}

/// Maximum number of sums of one pair: 1 GiB of memory.
const MOST_SUMS: usize = 1 << 29;

/// A semi-global matcher of stereo pairs; its memory is reused. The result depends on the pair and the options only.
#[derive(Debug, Default)]
pub struct StereoMatcher {
    /// Disparities of a reduced pair.
    found: Vec<f32>,
    left: Side,
    right: Side,
    sums: Vec<u16>,
    down: Pass,
    up: Pass,
    winners: [Winner; 2],
    components: Components,
}

/// The luminance and the census of one of the images.
#[derive(Debug, Default)]
struct Side {
    brightness: Brightness,
    census: Census,
}

impl StereoMatcher {
    /// Writes the disparity of each pixel of `left`, row by row: how far to the left its match in `right` lies, in
    /// pixels with a fraction; 0 where it is unknown. The pair must be rectified: matching pixels are in the same
    /// row.
    ///
    /// # Errors
    /// `InvalidInput` when the images differ in size, when `disparities` has another length, and when image and
    /// number of disparities together are too large.
    pub fn run_into(
        &mut self,
        left: &Image,
        right: &Image,
        options: &StereoOptions,
        disparities: &mut [f32],
    ) -> Result<()> {
        let size @ [width, height] = [left.width(), left.height()];
        if [right.width(), right.height()] != size {
            return Err(Error::invalid_input(format!(
                "the left image has {width}x{height} pixels and the right one {}x{}; pass a rectified pair of one size",
                right.width(),
                right.height()
            )));
        }
        if disparities.len() != width * height {
            return Err(Error::invalid_input(format!(
                "the disparity map has {} values, but the pair has {width}x{height} pixels; pass one value per pixel",
                disparities.len()
            )));
        }
        let shrink = options.downscale.clamp(1, width.min(height).max(1));
        if shrink == 1 {
            return self.match_pair([left, right], options, disparities);
        }
        let mut found = std::mem::take(&mut self.found);
        found.resize((width / shrink) * (height / shrink), 0.0);
        let matched = self.match_pair([left, right], options, &mut found);
        if matched.is_ok() {
            enlarge(&found, size, shrink, disparities);
        }
        self.found = found;
        matched
    }

    /// Matches blocks of `shrink` x `shrink` pixels; the disparities are in blocks.
    fn match_pair(
        &mut self,
        [left, right]: [&Image; 2],
        options: &StereoOptions,
        disparities: &mut [f32],
    ) -> Result<()> {
        let shrink = options.downscale.clamp(1, left.width().min(left.height()).max(1));
        let size @ [width, height] = [left.width(), left.height()].map(|side| side / shrink);
        let count = options.disparities.clamp(1, 1 << 12).div_ceil(shrink).next_multiple_of(16);
        let total = width.checked_mul(height).and_then(|pixels| pixels.checked_mul(count));
        let Some(total) = total.filter(|total| *total <= MOST_SUMS) else {
            return Err(Error::invalid_input(format!(
                "{count} disparities of {width}x{height} pixels are too many; resize the pair, increase shrink or reduce disparities"
            )));
        };
        let sides = [(left, &mut self.left, false), (right, &mut self.right, true)].map(Mutex::new);
        workers::run(2, 2, &|part| {
            let (image, Side { brightness, census }, is_right) = &mut *lock(&sides[part]);
            brightness.fill(&image.view(), size, shrink);
            census.fill(&brightness.levels, size, *is_right);
        });
        self.sums.resize(total, 0);
        self.down.begin(width, count);
        self.up.begin(width, count);
        let large = options.p2.min(MOST_PENALTY);
        let plan = Plan {
            width,
            count,
            from: options.min_disparity / shrink,
            penalties: Penalties { small: options.p1.min(large), large },
            checks: ConfidenceChecks {
                uniqueness: options.uniqueness.into(),
                disagreement: options.max_left_right_difference,
            },
        };
        let middle = height / 2;
        let words = [&self.left, &self.right]
            .map(|side| &side.census.words[..])
            .map(|words| words.split_at(middle * width));
        let [(left_upper, left_lower), (right_upper, right_lower)] = words;
        let (upper, lower) = self.sums.split_at_mut(middle * width * count);
        let (found_upper, found_lower) = disparities.split_at_mut(middle * width);
        let [first, second] = &mut self.winners;
        let [upper_words, lower_words] = [[left_upper, right_upper], [left_lower, right_lower]];
        both(
            Job {
                plan,
                pass: &mut self.down,
                is_backward: false,
                words: upper_words,
                sums: upper,
                found: None,
            },
            Job { plan, pass: &mut self.up, is_backward: true, words: lower_words, sums: lower, found: None },
        );
        let (found_lower, found_upper) = (Some((first, found_lower)), Some((second, found_upper)));
        both(
            Job {
                plan,
                pass: &mut self.down,
                is_backward: false,
                words: lower_words,
                sums: lower,
                found: found_lower,
            },
            Job {
                plan,
                pass: &mut self.up,
                is_backward: true,
                words: upper_words,
                sums: upper,
                found: found_upper,
            },
        );
        if options.speckle_size > 0 {
            let StereoOptions { speckle_size, speckle_range, .. } = *options;
            let least = speckle_size / (shrink * shrink) as u32;
            let range = speckle_range / shrink as f32;
            repair::remove_speckles(disparities, size, least, range, &mut self.components);
        }
        if options.fill {
            repair::fill_holes(disparities, width);
        }
        disparities.iter_mut().filter(|found| **found == UNKNOWN).for_each(|found| *found = 0.0);
        Ok(())
    }
}

/// Assigns each pixel the disparity of its block, in pixels; pixels beyond the last block take the nearest one.
fn enlarge(found: &[f32], [width, height]: [usize; 2], shrink: usize, disparities: &mut [f32]) {
    let [across, down] = [width, height].map(|side| side / shrink);
    for (y, row) in disparities.chunks_exact_mut(width).enumerate() {
        let squares = &found[(y / shrink).min(down - 1) * across..][..across];
        for (pixels, square) in row.chunks_mut(shrink).zip(squares.iter().chain(squares.last())) {
            pixels.fill(square * shrink as f32);
        }
    }
}

#[derive(Debug, Clone, Copy)]
struct Plan {
    width: usize,
    count: usize,
    from: usize,
    penalties: Penalties,
    checks: ConfidenceChecks,
}

/// The rows of a pass, and the disparities for the rows that the other pass has already processed.
struct Job<'a> {
    plan: Plan,
    pass: &'a mut Pass,
    is_backward: bool,
    /// Census words of the left and of the right image.
    words: [&'a [u64]; 2],
    sums: &'a mut [u16],
    found: Option<(&'a mut Winner, &'a mut [f32])>,
}

fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

fn both(first: Job<'_>, second: Job<'_>) {
    let jobs = [first, second].map(Mutex::new);
    workers::run(2, 2, &|part| run_with_best_isa(&mut lock(&jobs[part])));
}

#[cfg(target_arch = "x86_64")]
fn run_with_best_isa(job: &mut Job<'_>) {
    #[target_feature(enable = "avx2,popcnt")]
    unsafe fn go_avx2<B: Bytes>(job: &mut Job<'_>) {
        // SAFETY: the caller guarantees the instruction set and the number of disparities.
        unsafe { go::<B>(job) }
    }
    let is_wide = is_x86_feature_detected!("avx2") && is_x86_feature_detected!("popcnt");
    // SAFETY: the CPU features were checked; the number of disparities is a multiple of 16.
    unsafe {
        match is_wide {
            true if job.plan.count.is_multiple_of(bytes::Avx2::COUNT) => go_avx2::<bytes::Avx2>(job),
            true => go_avx2::<bytes::Sse2>(job),
            false => go::<bytes::Sse2>(job),
        }
    }
}

#[cfg(not(target_arch = "x86_64"))]
fn run_with_best_isa(job: &mut Job<'_>) {
    // SAFETY: every machine supports this type; the number of disparities is a multiple of 16.
    unsafe { go::<bytes::Portable>(job) }
}

/// # Safety
/// The CPU supports the instructions of `B`, and the number of disparities is a multiple of `B::COUNT`.
#[inline(always)]
unsafe fn go<B: Bytes>(job: &mut Job<'_>) {
    let Plan { width, count, from, penalties, checks } = job.plan;
    let [left, right] = job.words;
    let height = left.len() / width;
    for step in 0..height {
        let y = if job.is_backward { height - 1 - step } else { step };
        let row = y * width..(y + 1) * width;
        let sums = &mut job.sums[y * width * count..][..width * count];
        let (left, right) = (&left[row.clone()], &right[row.clone()]);
        let is_first = job.found.is_none();
        // SAFETY: the caller guarantees the instruction set and the number of disparities.
        unsafe { job.pass.row::<B>(left, right, sums, from, penalties, [job.is_backward, is_first]) };
        if let Some((winner, found)) = &mut job.found {
            winner.row(sums, count, from, checks, &mut found[row]);
        }
    }
}

#[cfg(test)]
mod tests;
