//! The best disparity of each pixel.

/// Thresholds of the confidence checks.
#[derive(Debug, Clone, Copy)]
pub(super) struct ConfidenceChecks {
    /// Margin in percent by which the second best must be worse.
    pub uniqueness: u16,
    /// Maximum difference to the right image's disparity, in pixels; `None` skips the check.
    pub disagreement: Option<u16>,
}

/// Value of unknown disparities.
pub(super) const UNKNOWN: f32 = -1.0;

/// Working memory for a row.
#[derive(Debug, Default)]
pub(super) struct Winner {
    /// Minimum sum of each pixel of the right image, in reverse, and its disparity.
    right_least: Vec<u16>,
    right_best: Vec<u16>,
    /// Best disparity of each pixel of the left image.
    best: Vec<u16>,
}

impl Winner {
    /// Writes the disparities of a row, or [`UNKNOWN`]. `sums` are `[width, disparities]`; `from` is the first
    /// disparity.
    #[inline(always)]
    pub fn row(
        &mut self,
        sums: &[u16],
        disparities: usize,
        from: usize,
        checks: ConfidenceChecks,
        out: &mut [f32],
    ) {
        let width = out.len();
        let Self { right_least, right_best, best } = self;
        for (values, start) in [(&mut *right_least, u16::MAX), (right_best, 0), (best, 0)] {
            values.clear();
            values.resize(width, start);
        }
        for (x, (sums, out)) in sums.chunks_exact(disparities).zip(out.iter_mut()).enumerate() {
            *out = UNKNOWN;
            // Beyond this, the right image has no pixel.
            let Some(last) = x.checked_sub(from) else { continue };
            let sums = &sums[..disparities.min(last + 1)];
            let first = width - 1 - x + from;
            let seen = right_least[first..].iter_mut().zip(&mut right_best[first..]);
            for ((sum, disparity), (least, best)) in sums.iter().zip(0_u16..).zip(seen) {
                let is_better = sum < least;
                *least = if is_better { *sum } else { *least };
                *best = if is_better { disparity } else { *best };
            }
            let least = sums.iter().copied().fold(u16::MAX, u16::min);
            let Some(at) = sums.iter().position(|sum| *sum == least) else { continue };
            best[x] = at as u16;
            let bound = u32::from(least) * 100 / u32::from(100 - checks.uniqueness.min(99));
            let bound = u16::try_from(bound).unwrap_or(u16::MAX);
            let rivals = sums.iter().map(|sum| u16::from(*sum < bound)).sum::<u16>();
            let near = sums[at.saturating_sub(1)..(at + 2).min(sums.len())].iter();
            if rivals > near.map(|sum| u16::from(*sum < bound)).sum() {
                continue;
            }
            *out = (at + from) as f32 + between(sums, at);
        }
        let Some(most) = checks.disagreement else { return };
        for (x, out) in out.iter_mut().enumerate().filter(|(_, out)| **out >= 0.0) {
            let there = width - 1 - x + from + usize::from(best[x]);
            if right_best[there].abs_diff(best[x]) > most {
                *out = UNKNOWN;
            }
        }
    }
}

/// Returns the offset of the sub-pixel minimum from the best disparity, -0.5..=0.5: the intersection of two lines of
/// equal slope through the neighbours (M. Shimizu, M. Okutomi, "Sub-pixel estimation error cancellation on area-based
/// matching", IJCV 2005).
#[inline(always)]
fn between(sums: &[u16], at: usize) -> f32 {
    let (Some(before), Some(after)) =
        (at.checked_sub(1).and_then(|before| sums.get(before)), sums.get(at + 1))
    else {
        return 0.0;
    };
    let [before, here, after] = [*before, sums[at], *after].map(f32::from);
    let slope = before.max(after) - here;
    if slope > 0.0 { 0.5 * (before - after) / slope } else { 0.0 }
}
