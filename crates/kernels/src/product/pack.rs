//! Packing: panels with the elements of a factor in the order in which the inner loop reads them.

/// A factor: its first element and the strides along the depth and across.
#[derive(Clone, Copy)]
pub(super) struct Source {
    pub(super) data: *const f32,
    /// Stride from one step of the depth to the next.
    pub(super) along: usize,
    /// Stride from one row of A, or one column of B, to the next.
    pub(super) across: usize,
}

/// Packs `count` rows of A (or columns of B) into panels of `width`, each `depth` steps of `width` numbers; the last
/// panel is padded with zeros.
///
/// # Safety
/// `width` is that of a tile: 4, 6, 8, 16 or 32. `source` is readable for `count` by `depth` numbers.
pub(super) unsafe fn pack(source: Source, count: usize, depth: usize, width: usize, panels: &mut [f32]) {
    if source.across == 1 {
        // With a constant width, the compiler emits a few moves.
        // SAFETY: the caller's promise.
        return unsafe {
            match width {
                4 => copy_runs::<4>(source, count, depth, panels),
                6 => copy_runs::<6>(source, count, depth, panels),
                8 => copy_runs::<8>(source, count, depth, panels),
                16 => copy_runs::<16>(source, count, depth, panels),
                _ => copy_runs::<32>(source, count, depth, panels),
            }
        };
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

/// Panels that are filled together: a cache line of the source is then read once or twice, not once per panel.
const TOGETHER: usize = 4;

unsafe fn copy_runs<const WIDTH: usize>(source: Source, count: usize, depth: usize, panels: &mut [f32]) {
    let size = depth * WIDTH;
    for (index, group) in panels.chunks_mut(TOGETHER * size).enumerate() {
        let first = index * TOGETHER * WIDTH;
        let whole = (count - first).min(TOGETHER * WIDTH) / WIDTH;
        let rest = (count - first).min(TOGETHER * WIDTH) - whole * WIDTH;
        if rest > 0 {
            group[whole * size..].fill(0.0);
        }
        let to = group.as_mut_ptr();
        for step in 0..depth {
            // SAFETY: by the contract of `pack`; the group has `whole` panels, and one more where there is a rest.
            unsafe {
                let (from, to) = (source.data.add(first + step * source.along), to.add(step * WIDTH));
                for panel in 0..whole {
                    let run = from.add(panel * WIDTH).cast::<[f32; WIDTH]>().read_unaligned();
                    to.add(panel * size).cast::<[f32; WIDTH]>().write_unaligned(run);
                }
                for i in 0..rest {
                    *to.add(whole * size + i) = *from.add(whole * WIDTH + i);
                }
            }
        }
    }
}

/// Transposes squares of four by four, which the compiler keeps in registers, and then the rest.
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
