//! Tables that depend on sizes only: the source samples that each output row and column blends.

use std::sync::{Mutex, PoisonError};

/// Number of cached plans: enough for a few cameras or crops at once.
const CACHE_SIZE: usize = 8;

/// Sum of the two fixed-point weights of a column.
pub(super) const ONE: u32 = 1 << 14;

/// Bytes that a kernel reads from a column's offset on; they contain both taps of a pixel of 3 or 4 bytes.
pub(super) const TAP_BYTES: usize = 16;

/// The two source samples between which an output sample lies.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Tap {
    pub(super) first: u32,
    pub(super) second: u32,
    /// Weight of the second sample, 0..=1.
    pub(super) weight: f32,
}

/// Returns the taps of `target` samples over `source` ones: half-pixel centres, replicated edge, no antialiasing, as
/// OpenCV's `INTER_LINEAR`. The taps are adjacent whenever there are at least two samples.
fn taps(source: usize, target: usize) -> impl Iterator<Item = Tap> {
    let scale = source as f64 / target as f64;
    let last = source.saturating_sub(2) as f64;
    (0..target).map(move |index| {
        let position = ((index as f64 + 0.5) * scale - 0.5).max(0.0);
        let first = position.floor().min(last);
        let second = (first as usize + 1).min(source - 1);
        let weight = if source > 1 { (position - first).min(1.0) } else { 0.0 };
        Tap { first: first as u32, second: second as u32, weight: weight as f32 }
    })
}

/// Sizes that a plan depends on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct Sizes {
    /// Width and height of the image.
    pub(super) source: [usize; 2],
    /// Width and height of its area in the input.
    pub(super) target: [usize; 2],
    /// Bytes from pixel to pixel for the packed kernels; 0 without them.
    pub(super) step: usize,
}

/// The tables for one pair of sizes.
#[derive(Debug, Default)]
pub(super) struct Plan {
    sizes: Sizes,
    pub(super) rows: Vec<Tap>,
    pub(super) columns: Vec<Tap>,
    packed: PackedColumns,
    /// A copy of the last source row with padding, for views that end at the end of the memory.
    pub(super) last_row: Vec<u8>,
}

/// Columns in the form of the packed kernels.
#[derive(Debug, Default)]
pub(super) struct PackedColumns {
    offsets: Vec<u32>,
    weights: Vec<u32>,
    reach: usize,
}

impl PackedColumns {
    /// Returns the byte offset of each column's first tap.
    pub(super) fn offsets(&self) -> &[u32] {
        &self.offsets
    }

    /// Returns the weights of each column's taps in units of 1 / [`ONE`]: the first in the low half.
    pub(super) fn weights(&self) -> &[u32] {
        &self.weights
    }

    /// Returns the number of bytes of a row that are read: no offset plus [`TAP_BYTES`] is larger.
    pub(super) fn reach(&self) -> usize {
        self.reach
    }

    fn build(&mut self, columns: &[Tap], step: usize) {
        self.offsets.clear();
        self.offsets.extend(columns.iter().map(|tap| tap.first * step as u32));
        self.weights.clear();
        self.weights.extend(columns.iter().map(|tap| {
            let second = (tap.weight * ONE as f32).round() as u32;
            (ONE - second) | second << 16
        }));
        self.reach = self.offsets.iter().max().map_or(0, |&offset| offset as usize + TAP_BYTES);
    }
}

impl Plan {
    /// Returns the columns in the form of the packed kernels.
    pub(super) fn packed(&self) -> &PackedColumns {
        &self.packed
    }

    /// Computes the tables for `sizes`; memory is reused.
    fn rebuild(&mut self, sizes: Sizes) {
        self.sizes = sizes;
        self.columns.clear();
        self.columns.extend(taps(sizes.source[0], sizes.target[0]));
        self.rows.clear();
        self.rows.extend(taps(sizes.source[1], sizes.target[1]));
        if sizes.step > 0 {
            self.packed.build(&self.columns, sizes.step);
        }
    }
}

/// A cache of plans, so that a stream of images of one size allocates nothing.
#[derive(Debug, Default)]
pub(super) struct Plans {
    free: Mutex<Vec<Plan>>,
}

impl Plans {
    /// Calls `work` with a plan for `sizes`; several threads may do so at once.
    pub(super) fn with<R>(&self, sizes: Sizes, work: impl FnOnce(&mut Plan) -> R) -> R {
        let mut plan = self.take(sizes);
        if plan.sizes != sizes {
            plan.rebuild(sizes);
        }
        let result = work(&mut plan);
        self.free.lock().unwrap_or_else(PoisonError::into_inner).push(plan);
        result
    }

    /// Returns the plan for `sizes`: the cached one, a new one while the cache has space, or the least recently used
    /// one.
    fn take(&self, sizes: Sizes) -> Plan {
        let mut free = self.free.lock().unwrap_or_else(PoisonError::into_inner);
        match free.iter().rposition(|plan| plan.sizes == sizes) {
            Some(index) => free.remove(index),
            None if free.len() < CACHE_SIZE => Plan::default(),
            None => free.remove(0),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn taps_are_opencvs() {
        let down: Vec<Tap> = taps(6, 2).collect();
        assert_eq!(down[0], Tap { first: 1, second: 2, weight: 0.0 });
        assert_eq!(down[1], Tap { first: 4, second: 5, weight: 0.0 });
        let up: Vec<Tap> = taps(2, 4).collect();
        assert_eq!(up.map_weights(), [0.0, 0.25, 0.75, 1.0]);
        assert!(up.iter().all(|tap| (tap.first, tap.second) == (0, 1)));
        assert!(taps(1, 5).all(|tap| tap == Tap { first: 0, second: 0, weight: 0.0 }));
    }

    trait Weights {
        fn map_weights(&self) -> Vec<f32>;
    }

    impl Weights for Vec<Tap> {
        fn map_weights(&self) -> Vec<f32> {
            self.iter().map(|tap| tap.weight).collect()
        }
    }

    #[test]
    fn plans_are_kept_by_size_and_bounded() {
        let plans = Plans::default();
        for width in 1..30 {
            plans.with(Sizes { source: [width, 4], target: [7, 7], step: 3 }, |plan| {
                assert_eq!((plan.columns.len(), plan.rows.len()), (7, 7));
                assert!(
                    plan.packed()
                        .offsets()
                        .iter()
                        .all(|&at| at as usize + TAP_BYTES <= plan.packed().reach())
                );
            });
        }
        assert_eq!(plans.free.lock().unwrap().len(), CACHE_SIZE);
    }
}
