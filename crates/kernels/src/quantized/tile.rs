//! The inner loop: some rows of the input by some registers of outputs.

use super::dots::Dots;
use super::filters::Panel;
use super::output::Bounds;

/// Rows of the largest tile with that many registers across: the sums use most registers.
pub(super) const fn most_rows<V: Dots>(vectors: usize) -> usize {
    match (V::VECTORS > 2, vectors) {
        (true, 1 | 2) => 12,
        (true, _) => 8,
        (false, _) => 4,
    }
}

/// Input rows and output rows of a piece.
pub(super) struct Rows<'a> {
    /// First word of the first row.
    pub(super) x: *const u8,
    /// Bytes from one row of the input to the next.
    pub(super) x_stride: usize,
    /// Sum of the bytes of each row, or null.
    pub(super) sums: *const i32,
    /// First output of the first row.
    pub(super) y: *mut u8,
    /// Outputs from one row to the next.
    pub(super) y_stride: usize,
    pub(super) words: usize,
    pub(super) count: usize,
    /// Bounds of bytes; without them the sums are stored as they are.
    pub(super) bounds: Option<&'a Bounds>,
}

/// Computes the outputs of a panel for all rows, in as few tiles as possible of nearly equal size.
///
/// # Safety
/// The pointers are valid for the stated sizes.
#[inline(always)]
pub(super) unsafe fn panel<V: Dots>(rows: &Rows<'_>, panel: &Panel) {
    // SAFETY: passed on.
    unsafe {
        match panel.vectors {
            1 => tiles::<V, 1>(rows, panel),
            2 => tiles::<V, 2>(rows, panel),
            _ => tiles::<V, 3>(rows, panel),
        }
    }
}

#[inline(always)]
unsafe fn tiles<V: Dots, const N: usize>(rows: &Rows<'_>, panel: &Panel) {
    let most = most_rows::<V>(N);
    let mut at = 0;
    while at < rows.count {
        let left = rows.count - at;
        let size = left.div_ceil(left.div_ceil(most));
        // SAFETY: passed on.
        unsafe {
            match size {
                1 => tile::<V, 1, N>(rows, panel, at),
                2 => tile::<V, 2, N>(rows, panel, at),
                3 => tile::<V, 3, N>(rows, panel, at),
                4 => tile::<V, 4, N>(rows, panel, at),
                5 if most > 4 => tile::<V, 5, N>(rows, panel, at),
                6 if most > 4 => tile::<V, 6, N>(rows, panel, at),
                7 if most > 4 => tile::<V, 7, N>(rows, panel, at),
                8 if most > 4 => tile::<V, 8, N>(rows, panel, at),
                9 if most > 8 => tile::<V, 9, N>(rows, panel, at),
                10 if most > 8 => tile::<V, 10, N>(rows, panel, at),
                11 if most > 8 => tile::<V, 11, N>(rows, panel, at),
                _ if most > 8 => tile::<V, 12, N>(rows, panel, at),
                _ => (),
            }
        }
        at += size;
    }
}

#[inline(always)]
unsafe fn tile<V: Dots, const R: usize, const N: usize>(rows: &Rows<'_>, panel: &Panel, at: usize) {
    // SAFETY: passed on.
    unsafe {
        let mut x = [std::ptr::null::<i32>(); R];
        for i in 0..R {
            x[i] = rows.x.add((at + i) * rows.x_stride).cast();
        }
        let mut sums = [[V::splat(0); N]; R];
        let mut weights = panel.weights;
        for word in 0..rows.words {
            let mut across = [V::splat(0); N];
            for j in 0..N {
                across[j] = V::load(weights.add(j * V::WIDTH));
            }
            for i in 0..R {
                let x = V::splat(x[i].add(word).read_unaligned());
                for j in 0..N {
                    sums[i][j] = sums[i][j].dot(x, across[j]);
                }
            }
            weights = weights.add(N * V::WIDTH);
        }
        finish(rows, panel, at, &sums);
    }
}

/// Adds constants and corrections, and stores bytes or sums.
#[inline(always)]
unsafe fn finish<V: Dots, const R: usize, const N: usize>(
    rows: &Rows<'_>,
    panel: &Panel,
    at: usize,
    sums: &[[V; N]; R],
) {
    // SAFETY: passed on.
    unsafe {
        for i in 0..R {
            let of_row = if rows.sums.is_null() { 0 } else { *rows.sums.add(at + i) };
            for j in 0..N {
                let (first, count) = (j * V::WIDTH, panel.used.saturating_sub(j * V::WIDTH).min(V::WIDTH));
                let mut sum = sums[i][j].add(V::load(panel.constants.add(first)));
                if !rows.sums.is_null() {
                    sum = sum.add_multiple(of_row, V::load(panel.corrections.add(first)));
                }
                let to = (at + i) * rows.y_stride + panel.first + first;
                match rows.bounds {
                    Some(bounds) => {
                        sum.store_bytes(panel.scales.add(first), bounds, rows.y.add(to), count);
                    }
                    None => store_sums(sum, rows.y.cast::<i32>().add(to), count),
                }
            }
        }
    }
}

#[inline(always)]
unsafe fn store_sums<V: Dots>(sums: V, to: *mut i32, count: usize) {
    // SAFETY: passed on.
    unsafe {
        if count == V::WIDTH {
            return sums.store(to);
        }
        let mut few = [0; super::dots::MAX_WIDTH];
        sums.store(few.as_mut_ptr());
        to.copy_from_nonoverlapping(few.as_ptr(), count);
    }
}
