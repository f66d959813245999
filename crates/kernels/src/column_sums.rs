use crate::Activation;
use crate::isa::{Isa, for_every_isa};
use crate::lanes::Lanes;

/// Adds the columns of `values`, whose rows have as many numbers as `sums`, row after row.
///
/// # Panics
/// Where `values` is no whole number of rows.
pub fn add_column_sums(isa: Isa, values: &[f32], sums: &mut [f32]) {
    let rows = rows_of(values.len(), sums.len());
    // SAFETY: `values` has `rows` rows of as many numbers as `sums`.
    unsafe { dispatch_sum(isa, values.as_ptr(), rows, sums.len(), sums.as_mut_ptr()) }
}

/// [`Activation::backward_in_place`] and [`add_column_sums`] in one pass: `dy` becomes the gradient before the
/// activation, and its columns, the gradient of a bias, are added to `sums`.
///
/// # Panics
/// Where the lengths do not fit.
pub(crate) fn backward_with_column_sums(
    isa: Isa,
    activation: Activation,
    y: &[f32],
    dy: &mut [f32],
    sums: &mut [f32],
) {
    assert_eq!(y.len(), dy.len(), "outputs and their gradients differ in number");
    let rows = rows_of(y.len(), sums.len());
    // SAFETY: both have `rows` rows of as many numbers as `sums`.
    unsafe {
        dispatch_both(isa, activation, [rows, sums.len()], y.as_ptr(), dy.as_mut_ptr(), sums.as_mut_ptr());
    }
}

fn rows_of(length: usize, columns: usize) -> usize {
    let rows = length.checked_div(columns).unwrap_or(0);
    assert_eq!(rows * columns, length, "{length} numbers are no rows of {columns}");
    rows
}

for_every_isa!(
    fn dispatch_sum = sum(values: *const f32, rows: usize, columns: usize, sums: *mut f32)
);

#[inline(always)]
unsafe fn sum<V: Lanes>(values: *const f32, rows: usize, columns: usize, sums: *mut f32) {
    let whole = columns / V::WIDTH * V::WIDTH;
    // SAFETY: by contract there are `rows` rows of `columns` numbers, and `columns` sums.
    unsafe {
        for j in (0..whole).step_by(V::WIDTH) {
            let mut total = V::load(sums.add(j));
            for i in 0..rows {
                total = total.add(V::load(values.add(i * columns + j)));
            }
            total.store(sums.add(j));
        }
        for i in 0..rows {
            for j in whole..columns {
                *sums.add(j) += *values.add(i * columns + j);
            }
        }
    }
}

for_every_isa!(
    fn dispatch_both = both(
        activation: Activation, size: [usize; 2], y: *const f32, dy: *mut f32, sums: *mut f32,
    )
);

#[inline(always)]
unsafe fn both<V: Lanes>(
    activation: Activation,
    [rows, columns]: [usize; 2],
    y: *const f32,
    dy: *mut f32,
    sums: *mut f32,
) {
    // SAFETY: by contract there are `rows` rows of `columns` numbers, and `columns` sums.
    unsafe {
        for j in (0..columns).step_by(V::WIDTH) {
            let count = V::WIDTH.min(columns - j);
            if count < V::WIDTH {
                let mut total = V::load_some(sums.add(j), count);
                for at in (0..rows).map(|i| i * columns + j) {
                    let before =
                        activation.gradient(V::load_some(y.add(at), count), V::load_some(dy.add(at), count));
                    before.store_some(dy.add(at), count);
                    total = total.add(before);
                }
                total.store_some(sums.add(j), count);
            } else {
                let mut total = V::load(sums.add(j));
                for at in (0..rows).map(|i| i * columns + j) {
                    let before = activation.gradient(V::load(y.add(at)), V::load(dy.add(at)));
                    before.store(dy.add(at));
                    total = total.add(before);
                }
                total.store(sums.add(j));
            }
        }
    }
}
