//! Sums over pixels of the products of two packed matrices, `left^T right`: gradients of weights.

use crate::compute::Compute;
use crate::isa::for_every_isa;
use crate::lanes::Lanes;

/// Rows of the result that lie side by side in the left matrix.
pub(super) const ROWS: usize = 16;
/// Columns of the result that lie side by side in the right matrix.
pub(super) const COLUMNS: usize = 32;
/// Numbers of a tile of the result.
pub(super) const TILE: usize = ROWS * COLUMNS;
/// Numbers of both matrices of a block of pixels.
const BLOCK: usize = 1 << 21;
/// Pixels of which columns stay in the L1 cache while all rows pass.
const PART: usize = 128;

/// Sizes of several products: matrices of planes, each `[strips, pixels, ROWS or COLUMNS]`. The result is `[planes, strips of rows,
/// strips of columns, ROWS, COLUMNS]`.
#[derive(Debug, Clone, Copy)]
pub(super) struct PixelProducts {
    /// Planes of the right matrix and of the result.
    pub(super) planes: usize,
    /// Whether all planes have the same left matrix.
    pub(super) shares_left: bool,
    /// Strips of rows and of columns.
    pub(super) strips: [usize; 2],
    /// Pixels of a block.
    pub(super) pixels: usize,
}

impl PixelProducts {
    /// Returns sizes whose blocks of pixels stay in a cache.
    pub(super) fn new(planes: usize, shares_left: bool, [rows, columns]: [usize; 2], pixels: usize) -> Self {
        let strips = [rows.div_ceil(ROWS), columns.div_ceil(COLUMNS)];
        let left_planes = if shares_left { 1 } else { planes };
        let per_pixel = left_planes * strips[0] * ROWS + planes * strips[1] * COLUMNS;
        Self { planes, shares_left, strips, pixels: (BLOCK / per_pixel).clamp(64, 2048).min(pixels) }
    }

    /// Returns the numbers of the left matrix of a block, the right one and the result.
    pub(super) fn lengths(&self) -> [usize; 3] {
        let left_planes = if self.shares_left { 1 } else { self.planes };
        [
            left_planes * self.strips[0] * self.pixels * ROWS,
            self.planes * self.strips[1] * self.pixels * COLUMNS,
            self.planes * self.strips[0] * self.strips[1] * TILE,
        ]
    }

    /// Returns the index of an element of a plane of the result.
    pub(super) fn at(&self, row: usize, column: usize) -> usize {
        let tile = row / ROWS * self.strips[1] + column / COLUMNS;
        tile * TILE + row % ROWS * COLUMNS + column % COLUMNS
    }

    /// Returns the numbers of a plane of the result.
    pub(super) fn plane(&self) -> usize {
        self.strips[0] * self.strips[1] * TILE
    }

    /// Adds the products of the first `pixels` pixels of a block.
    pub(super) fn add(
        &self,
        compute: &Compute,
        left: &[f32],
        right: &[f32],
        pixels: usize,
        sums: &mut [f32],
    ) {
        let [left_length, right_length, length] = self.lengths();
        assert!(pixels <= self.pixels, "more pixels than a block has");
        assert!(left.len() >= left_length && right.len() >= right_length, "the matrices are too short");
        let [rows, columns] = self.strips;
        compute.pool().run_on_pieces(&mut sums[..length], TILE, |index, sums| {
            let (row, column) = (index / columns % rows, index % columns);
            let plane = index / (rows * columns);
            let left_plane = if self.shares_left { 0 } else { plane };
            let left = &left[(left_plane * rows + row) * self.pixels * ROWS..][..pixels * ROWS];
            let right = &right[(plane * columns + column) * self.pixels * COLUMNS..][..pixels * COLUMNS];
            // SAFETY: the matrices have that many pixels.
            unsafe { dispatch_tile(compute.isa(), left, right, sums) };
        });
    }
}

for_every_isa!(fn dispatch_tile = add_tile(left: &[f32], right: &[f32], sums: &mut [f32]));

/// # Safety
/// The instruction set is enabled; both matrices have equally many pixels.
#[inline(always)]
unsafe fn add_tile<V: Lanes>(left: &[f32], right: &[f32], sums: &mut [f32]) {
    let pixels = left.len() / ROWS;
    for first in (0..pixels).step_by(PART) {
        let count = (pixels - first).min(PART);
        // SAFETY: tiles and pixels lie within the slices.
        unsafe {
            let (left, right) = (left.as_ptr().add(first * ROWS), right.as_ptr().add(first * COLUMNS));
            match (V::WIDTH, V::REGISTERS) {
                (16, _) => part::<V, 8, 2>(left, right, count, sums.as_mut_ptr()),
                (_, 32..) => part::<V, 4, 4>(left, right, count, sums.as_mut_ptr()),
                _ => part::<V, 4, 2>(left, right, count, sums.as_mut_ptr()),
            }
        }
    }
}

/// Adds the products of a part of the pixels to a tile, `R` rows and `N` registers of columns at a time.
#[inline(always)]
unsafe fn part<V: Lanes, const R: usize, const N: usize>(
    left: *const f32,
    right: *const f32,
    count: usize,
    sums: *mut f32,
) {
    for column in (0..COLUMNS).step_by(N * V::WIDTH) {
        for row in (0..ROWS).step_by(R) {
            // SAFETY: passed on.
            unsafe {
                let sums = sums.add(row * COLUMNS + column);
                let mut all = [[V::splat(0.0); N]; R];
                for (r, all) in all.iter_mut().enumerate() {
                    for (n, sum) in all.iter_mut().enumerate() {
                        *sum = V::load(sums.add(r * COLUMNS + n * V::WIDTH));
                    }
                }
                let (mut left, mut right) = (left.add(row), right.add(column));
                for _ in 0..count {
                    let mut vectors = [V::splat(0.0); N];
                    for (n, vector) in vectors.iter_mut().enumerate() {
                        *vector = V::load(right.add(n * V::WIDTH));
                    }
                    for (r, all) in all.iter_mut().enumerate() {
                        let factor = V::splat(*left.add(r));
                        for (sum, vector) in all.iter_mut().zip(vectors) {
                            *sum = vector.mul_add(factor, *sum);
                        }
                    }
                    left = left.wrapping_add(ROWS);
                    right = right.wrapping_add(COLUMNS);
                }
                for (r, all) in all.iter().enumerate() {
                    for (n, sum) in all.iter().enumerate() {
                        sum.store(sums.add(r * COLUMNS + n * V::WIDTH));
                    }
                }
            }
        }
    }
}
