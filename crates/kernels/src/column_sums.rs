use crate::Activation;
use crate::isa::{Isa, for_every_isa};
use crate::lanes::Lanes;

/// Adds the column sums of `values`, whose rows have as many numbers as `sums`, to `sums`.
///
/// # Panics
/// When the length of `values` is not a multiple of the row length.
pub fn add_column_sums(isa: Isa, values: &[f32], sums: &mut [f32]) {
    let rows = rows_of(values.len(), sums.len());
    // SAFETY: `values` has `rows` rows of as many numbers as `sums`.
    unsafe { dispatch_sum(isa, values.as_ptr(), rows, sums.len(), sums.as_mut_ptr()) }
}

/// Computes [`Activation::backward_in_place`] and [`add_column_sums`] in one pass: `dy` becomes the gradient before
/// the activation, and its column sums, the gradient of a bias, are added to `sums`.
///
/// # Panics
/// When the lengths do not match.
pub(crate) fn backward_with_column_sums(
    isa: Isa,
    activation: Activation,
    y: &[f32],
    dy: &mut [f32],
    sums: &mut [f32],
) {
    assert_eq!(y.len(), dy.len(), "`y` and `dy` must have equal lengths");
    let rows = rows_of(y.len(), sums.len());
    // SAFETY: both have `rows` rows of as many numbers as `sums`.
    unsafe {
        dispatch_both(isa, activation, [rows, sums.len()], y.as_ptr(), dy.as_mut_ptr(), sums.as_mut_ptr());
    }
}

fn rows_of(length: usize, columns: usize) -> usize {
    let rows = length.checked_div(columns).unwrap_or(0);
    assert_eq!(rows * columns, length, "{length} numbers are not divisible into rows of {columns}");
    rows
}

for_every_isa!(
    fn dispatch_sum = sum(values: *const f32, rows: usize, columns: usize, sums: *mut f32)
);

#[inline(always)]
unsafe fn sum<V: Lanes>(values: *const f32, rows: usize, columns: usize, sums: *mut f32) {
    let mut at = 0;
    // SAFETY: by contract there are `rows` rows of `columns` numbers, and `columns` sums.
    unsafe {
        while columns - at >= 4 * V::WIDTH {
            sum_of_columns::<V, 4>(values.add(at), rows, columns, sums.add(at));
            at += 4 * V::WIDTH;
        }
        while columns - at >= V::WIDTH {
            sum_of_columns::<V, 1>(values.add(at), rows, columns, sums.add(at));
            at += V::WIDTH;
        }
        let rest = columns - at;
        if rest > 0 {
            let mut total = V::load_some(sums.add(at), rest);
            for i in 0..rows {
                total = total.add(V::load_some(values.add(i * columns + at), rest));
            }
            total.store_some(sums.add(at), rest);
        }
    }
}

/// Sums the columns of R registers.
#[inline(always)]
unsafe fn sum_of_columns<V: Lanes, const R: usize>(
    values: *const f32,
    rows: usize,
    columns: usize,
    sums: *mut f32,
) {
    // SAFETY: by contract there are `rows` rows of `columns` numbers, of which those of R registers are within.
    unsafe {
        let mut totals = [V::splat(0.0); R];
        for (i, total) in totals.iter_mut().enumerate() {
            *total = V::load(sums.add(i * V::WIDTH));
        }
        for row in 0..rows {
            for (i, total) in totals.iter_mut().enumerate() {
                *total = total.add(V::load(values.add(row * columns + i * V::WIDTH)));
            }
        }
        for (i, total) in totals.iter().enumerate() {
            total.store(sums.add(i * V::WIDTH));
        }
    }
}

for_every_isa!(
    fn dispatch_both = both(
        activation: Activation, size: [usize; 2], y: *const f32, dy: *mut f32, sums: *mut f32,
    )
);

/// Rows that are summed together, so that `sums` is read and written once for them.
const TOGETHER: usize = 4;

#[inline(always)]
unsafe fn both<V: Lanes>(
    activation: Activation,
    [rows, columns]: [usize; 2],
    y: *const f32,
    dy: *mut f32,
    sums: *mut f32,
) {
    let whole = rows / TOGETHER * TOGETHER;
    // SAFETY: by contract there are `rows` rows of `columns` numbers, and `columns` sums.
    unsafe {
        for at in (0..whole).step_by(TOGETHER).map(|row| row * columns) {
            both_of_rows::<V, TOGETHER>(activation, columns, y.add(at), dy.add(at), sums);
        }
        for at in (whole..rows).map(|row| row * columns) {
            both_of_rows::<V, 1>(activation, columns, y.add(at), dy.add(at), sums);
        }
    }
}

#[inline(always)]
unsafe fn both_of_rows<V: Lanes, const R: usize>(
    activation: Activation,
    columns: usize,
    y: *const f32,
    dy: *mut f32,
    sums: *mut f32,
) {
    let whole = columns / V::WIDTH * V::WIDTH;
    // SAFETY: by contract there are R rows of `columns` numbers, and `columns` sums.
    unsafe {
        for j in (0..whole).step_by(V::WIDTH) {
            let mut total = V::load(sums.add(j));
            for at in (0..R).map(|i| i * columns + j) {
                let before = activation.gradient(V::load(y.add(at)), V::load(dy.add(at)));
                before.store(dy.add(at));
                total = total.add(before);
            }
            total.store(sums.add(j));
        }
        let rest = columns - whole;
        if rest > 0 {
            let mut total = V::load_some(sums.add(whole), rest);
            for at in (0..R).map(|i| i * columns + whole) {
                let before =
                    activation.gradient(V::load_some(y.add(at), rest), V::load_some(dy.add(at), rest));
                before.store_some(dy.add(at), rest);
                total = total.add(before);
            }
            total.store_some(sums.add(whole), rest);
        }
    }
}
