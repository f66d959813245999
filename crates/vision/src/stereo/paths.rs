//! Costs of disparities, aggregated along four of the eight paths.

use super::bytes::Bytes;
use super::census::BITS;

/// Maximum penalty: a cost plus a penalty fits into a byte.
pub(super) const MOST_PENALTY: u8 = u8::MAX - BITS;

/// Four paths: along the row, and from the three pixels of the previous row. One pass goes down the image and to the
/// right, the other up and to the left; both index pixels in their own order.
#[derive(Debug, Default)]
pub(super) struct Pass {
    width: usize,
    disparities: usize,
    costs: Vec<u8>,
    /// Path costs of the previous and the current row, by path and pixel, with a byte at both ends that is never the
    /// minimum.
    before: Vec<u8>,
    now: Vec<u8>,
    /// Minimum of each path and pixel.
    least_before: Vec<u8>,
    least_now: Vec<u8>,
    along: [Vec<u8>; 2],
    nothing: Vec<u8>,
    is_first_row: bool,
}

/// Penalties of a change of the disparity.
#[derive(Debug, Clone, Copy)]
pub(super) struct Penalties {
    /// For a change by one pixel (P1).
    pub small: u8,
    /// For a larger change (P2).
    pub large: u8,
}

impl Pass {
    /// Resets the pass for the edge of an image.
    pub fn begin(&mut self, width: usize, disparities: usize) {
        (self.width, self.disparities, self.is_first_row) = (width, disparities, true);
        let stride = disparities + 2;
        self.costs.resize(disparities, 0);
        for (sums, count) in [(&mut self.before, 3 * width), (&mut self.now, 3 * width)]
            .into_iter()
            .chain(self.along.iter_mut().map(|sums| (sums, 1)))
        {
            sums.clear();
            sums.resize(count * stride, u8::MAX);
        }
        for leasts in [&mut self.least_before, &mut self.least_now] {
            leasts.clear();
            leasts.resize(3 * width, 0);
        }
        self.nothing.clear();
        self.nothing.resize(stride, 0);
    }

    /// Adds the path costs of the next row to `sums`, `[width, disparities]`. `left` are the census words of the row
    /// in the left image, `right` those in the right one in reverse; `from` is the first disparity. The first pass
    /// over a row overwrites `sums`.
    ///
    /// # Safety
    /// The CPU supports the instructions of `B`, and the number of disparities is a multiple of `B::COUNT`.
    #[inline(always)]
    pub unsafe fn row<B: Bytes>(
        &mut self,
        left: &[u64],
        right: &[u64],
        sums: &mut [u16],
        from: usize,
        penalties: Penalties,
        [is_backward, is_first]: [bool; 2],
    ) {
        let Self { width, disparities, costs, before, now, least_before, least_now, along, nothing, .. } =
            self;
        let (width, disparities, stride) = (*width, *disparities, *disparities + 2);
        let [along_before, along_now] = along;
        let mut least_along = 0;
        for step in 0..width {
            let x = if is_backward { width - 1 - step } else { step };
            fill_costs(costs, left[x], right, width - 1 - x + from);
            let sums = &mut sums[x * disparities..][..disparities];
            let after = &mut along_now[..stride];
            let history = if step == 0 { &nothing[..] } else { &along_before[..stride] };
            // SAFETY: the caller guarantees the instruction set and the number of disparities.
            least_along = unsafe {
                match is_first {
                    true => advance::<B, true>(costs, history, least_along, penalties, after, sums),
                    false => advance::<B, false>(costs, history, least_along, penalties, after, sums),
                }
            };
            std::mem::swap(along_before, along_now);
            for path in 0..3 {
                // From the previous pixel, the same one, the next one.
                let other = (step + path).wrapping_sub(1);
                let is_known = !self.is_first_row && other < width;
                let (history, least) = match is_known {
                    true => {
                        let at = path * width + other;
                        (&before[at * stride..][..stride], least_before[at])
                    }
                    false => (&nothing[..], 0),
                };
                let at = path * width + step;
                let after = &mut now[at * stride..][..stride];
                // SAFETY: the caller guarantees the instruction set and the number of disparities.
                least_now[at] = unsafe { advance::<B, false>(costs, history, least, penalties, after, sums) };
            }
        }
        std::mem::swap(before, now);
        std::mem::swap(least_before, least_now);
        self.is_first_row = false;
    }
}

/// Writes the Hamming distance of the census words at each disparity; half of the bits where the right image has no
/// pixel.
#[inline(always)]
fn fill_costs(costs: &mut [u8], word: u64, right: &[u64], first: usize) {
    let there = right.get(first..).unwrap_or_default();
    let count = there.len().min(costs.len());
    let (inside, outside) = costs.split_at_mut(count);
    for (cost, other) in inside.iter_mut().zip(there) {
        *cost = (word ^ other).count_ones() as u8;
    }
    outside.fill(BITS / 2);
}

/// Computes one step of a path (Hirschmüller's equation 13): adds to `sums`, or overwrites them, and returns the
/// minimum.
///
/// # Safety
/// The CPU supports the instructions of `B`.
#[inline(always)]
unsafe fn advance<B: Bytes, const IS_FIRST: bool>(
    costs: &[u8],
    before: &[u8],
    least: u8,
    penalties: Penalties,
    after: &mut [u8],
    sums: &mut [u16],
) -> u8 {
    let count = costs.len();
    let (before, after, sums) = (&before[..count + 2], &mut after[..count + 2], &mut sums[..count]);
    // SAFETY: costs and sums have `B::COUNT` elements from `at` on; the previous path has one more on both sides.
    unsafe {
        let (small, jump) = (B::splat(penalties.small), B::splat(least.saturating_add(penalties.large)));
        let (least, mut lowest) = (B::splat(least), B::splat(u8::MAX));
        for at in (0..count - count % B::COUNT).step_by(B::COUNT) {
            let before = before.as_ptr().add(at);
            let near = B::load(before).min(B::load(before.add(2))).saturating_add(small);
            // No overflow: the best is at most the minimum plus the larger penalty.
            let best = B::load(before.add(1)).min(near).min(jump).sub(least);
            let sum = B::load(costs.as_ptr().add(at)).add(best);
            sum.store(after.as_mut_ptr().add(at + 1));
            lowest = lowest.min(sum);
            sum.widen::<IS_FIRST>(sums.as_mut_ptr().add(at));
        }
        lowest.lowest()
    }
}
