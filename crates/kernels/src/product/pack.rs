//! Panels: the parts of a factor in the order in which the inner loop reads them.

/// Where a factor lies: its first number and the distances along the panels' long side and across.
#[derive(Clone, Copy)]
pub(super) struct Source {
    pub(super) data: *const f32,
    /// From one step of the depth to the next.
    pub(super) along: usize,
    /// From one row of A, or one column of B, to the next.
    pub(super) across: usize,
}

/// Packs `count` rows of A (or columns of B) into panels of `width`, each `depth` steps of `width` numbers; the last
/// panel is filled up with zeros.
///
/// # Safety
/// `source` is readable for `count` by `depth` numbers.
pub(super) unsafe fn pack(source: Source, count: usize, depth: usize, width: usize, panels: &mut [f32]) {
    if source.across == 1 {
        // SAFETY: the caller's promise.
        return unsafe { copy_runs(source, count, depth, width, panels) };
    }
    for (index, panel) in panels.chunks_exact_mut(depth * width).enumerate() {
        let first = index * width;
        let used = width.min(count - first);
        if used < width {
            panel.fill(0.0);
        }
        // SAFETY: `first + used` is at most `count`; the panel has `depth` steps of `width` numbers.
        unsafe {
            let source = Source { data: source.data.add(first * source.across), ..source };
            transpose(source, used, depth, width, panel.as_mut_ptr());
        }
    }
}

/// Panels that are filled at the same time: a cache line of the source is then read once or twice, not once for each.
const TOGETHER: usize = 4;

unsafe fn copy_runs(source: Source, count: usize, depth: usize, width: usize, panels: &mut [f32]) {
    let size = depth * width;
    for (index, group) in panels.chunks_mut(TOGETHER * size).enumerate() {
        let first = index * TOGETHER * width;
        let whole = (count - first).min(TOGETHER * width) / width;
        let rest = (count - first).min(TOGETHER * width) - whole * width;
        if rest > 0 {
            group[whole * size..].fill(0.0);
        }
        let to = group.as_mut_ptr();
        for step in 0..depth {
            // SAFETY: by the contract of `pack`; the group has `whole` panels, and one more where there is a rest.
            unsafe {
                let from = source.data.add(first + step * source.along);
                for panel in 0..whole {
                    copy_run(from.add(panel * width), to.add(panel * size + step * width), width);
                }
                for i in 0..rest {
                    *to.add(whole * size + step * width + i) = *from.add(whole * width + i);
                }
            }
        }
    }
}

/// Sizes known to the compiler become some moves.
#[inline(always)]
unsafe fn copy_run(from: *const f32, to: *mut f32, count: usize) {
    // SAFETY: by the contract of `pack`.
    unsafe {
        match count {
            4 => to.copy_from_nonoverlapping(from, 4),
            6 => to.copy_from_nonoverlapping(from, 6),
            8 => to.copy_from_nonoverlapping(from, 8),
            16 => to.copy_from_nonoverlapping(from, 16),
            32 => to.copy_from_nonoverlapping(from, 32),
            _ => to.copy_from_nonoverlapping(from, count),
        }
    }
}

/// Squares of four by four, which the compiler keeps in registers; then what is left over.
#[inline]
unsafe fn transpose(source: Source, used: usize, depth: usize, width: usize, panel: *mut f32) {
    let Source { data, along, across } = source;
    let (squares_across, squares_along) = (used / 4 * 4, if along == 1 { depth / 4 * 4 } else { 0 });
    // SAFETY: by the contract of `pack`.
    unsafe {
        for i in (0..squares_across).step_by(4) {
            for step in (0..squares_along).step_by(4) {
                let mut square = [[0.0; 4]; 4];
                for (k, row) in square.iter_mut().enumerate() {
                    *row = data.add((i + k) * across + step).cast::<[f32; 4]>().read_unaligned();
                }
                for k in 0..4 {
                    let column = square.map(|row| row[k]);
                    panel.add((step + k) * width + i).cast::<[f32; 4]>().write_unaligned(column);
                }
            }
        }
        for step in 0..depth {
            let first = if step < squares_along { squares_across } else { 0 };
            for i in first..used {
                *panel.add(step * width + i) = *data.add(i * across + step * along);
            }
        }
    }
}
