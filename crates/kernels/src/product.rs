use crate::aligned::{LEFT_PANELS, RIGHT_PANELS, with_buffer};
use crate::compute::Compute;
use crate::isa::{Isa, Set};
use crate::lanes::Lanes;
use crate::matrix::{Matrix, MatrixMut};
use crate::{Activation, lanes};

mod dots;
mod pack;
#[cfg(test)]
mod tests;
mod tile;

use dots::{MOST_COLUMNS, compute_dots};
use pack::{Source, pack};
use tile::{BiasAt, Block, Finish, VECTORS, compute_block};

/// A matrix product with bias and activation in the same pass: `C = activation(alpha A B + beta C + bias)`.
///
/// Each element is summed in the order of its products, in blocks of 256; with at most four columns and contiguous
/// rows of A, in the lanes of a register. Neither the number of rows nor that of threads changes the order. Where
/// `beta` is 0, C is not read and may hold anything, NaN included; where `alpha` is 0, A and B are not read.
///
/// ```
/// use opendr_kernels::{Activation, Bias, Compute, Matrix, MatrixMut, Product};
///
/// let (x, weights, bias) = ([1.0, -1.0], [2.0, 0.0, 0.0, 3.0], [0.5, 0.5]);
/// let mut y = [0.0; 2];
/// Product::new().bias(Bias::Columns(&bias)).activation(Activation::Relu).run(
///     &Compute::single(),
///     Matrix::new(&x, 1, 2),
///     Matrix::new(&weights, 2, 2),
///     MatrixMut::new(&mut y, 1, 2),
/// );
/// assert_eq!(y, [2.5, 0.0]);
/// ```
#[derive(Debug, Clone, Copy)]
pub struct Product<'a> {
    alpha: f32,
    beta: f32,
    bias: Bias<'a>,
    activation: Activation,
}

/// The bias of a product.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Bias<'a> {
    /// No bias.
    None,
    /// One value per row.
    Rows(&'a [f32]),
    /// One value per column.
    Columns(&'a [f32]),
}

/// Steps of the depth that are summed in registers: a panel of B then stays in the L1 cache.
const DEPTH_BLOCK: usize = 256;
/// Columns of B that are packed at a time: they stay in the outer caches.
const COLUMN_BLOCK: usize = 1024;
/// Number of multiplications from which on several threads are used.
const PARALLEL_FROM: usize = 1 << 19;

impl Default for Product<'_> {
    fn default() -> Self {
        Self::new()
    }
}

impl<'a> Product<'a> {
    /// Creates the product `C = A B`.
    pub const fn new() -> Self {
        Self { alpha: 1.0, beta: 0.0, bias: Bias::None, activation: Activation::Identity }
    }

    /// Sets the factor of the product.
    #[must_use]
    pub const fn alpha(self, alpha: f32) -> Self {
        Self { alpha, ..self }
    }

    /// Sets the factor of the previous content of C.
    #[must_use]
    pub const fn beta(self, beta: f32) -> Self {
        Self { beta, ..self }
    }

    /// Sets the bias.
    #[must_use]
    pub const fn bias(self, bias: Bias<'a>) -> Self {
        Self { bias, ..self }
    }

    /// Sets the activation function.
    #[must_use]
    pub const fn activation(self, activation: Activation) -> Self {
        Self { activation, ..self }
    }

    /// Computes the product.
    ///
    /// # Panics
    /// When the shapes of A, B, C and the bias do not match.
    pub fn run(&self, compute: &Compute, a: Matrix<'_>, b: Matrix<'_>, c: MatrixMut<'_>) {
        let (rows, columns, depth) = (c.shape.rows, c.shape.columns, a.shape.columns);
        assert_eq!(
            (a.shape.rows, b.shape.rows, b.shape.columns),
            (rows, depth, columns),
            "the shapes of A, B and C do not match"
        );
        let bias = match self.bias {
            Bias::None => BiasAt::None,
            Bias::Rows(bias) => {
                assert_eq!(bias.len(), rows, "a row bias needs one value per row");
                BiasAt::Rows(bias.as_ptr())
            }
            Bias::Columns(bias) => {
                assert_eq!(bias.len(), columns, "a column bias needs one value per column");
                BiasAt::Columns(bias.as_ptr())
            }
        };
        if rows == 0 || columns == 0 {
            return;
        }
        let finish = Finish { alpha: self.alpha, beta: self.beta, bias, activation: self.activation };
        let depth = if self.alpha == 0.0 { 0 } else { depth };
        let job = Job {
            rows,
            columns,
            depth,
            a: Source { data: a.data.as_ptr(), along: a.shape.column_stride, across: a.shape.row_stride },
            b: Source { data: b.data.as_ptr(), along: b.shape.row_stride, across: b.shape.column_stride },
            c: c.data.as_mut_ptr(),
            c_strides: [c.shape.row_stride, c.shape.column_stride],
            finish,
        };
        let tile = Tile::of(compute.isa());
        if job.is_dots() {
            return job.run_dots(compute, tile);
        }
        let job = if job.is_better_transposed(tile) { job.transposed() } else { job };
        job.run(compute, tile);
    }
}

/// Rows and columns of a tile.
#[derive(Clone, Copy)]
struct Tile {
    rows: usize,
    columns: usize,
}

impl Tile {
    fn of(isa: Isa) -> Self {
        fn size<V: Lanes>() -> Tile {
            Tile { rows: V::ROWS, columns: VECTORS * V::WIDTH }
        }
        match isa.set() {
            Set::Portable => size::<lanes::Portable>(),
            #[cfg(target_arch = "x86_64")]
            Set::Avx2 => size::<lanes::Avx2>(),
            #[cfg(target_arch = "x86_64")]
            Set::Avx512 => size::<lanes::Avx512>(),
            #[cfg(target_arch = "aarch64")]
            Set::Neon => size::<lanes::Neon>(),
        }
    }
}

/// A product of matching shapes.
#[derive(Clone, Copy)]
struct Job {
    rows: usize,
    columns: usize,
    depth: usize,
    a: Source,
    b: Source,
    c: *mut f32,
    c_strides: [usize; 2],
    finish: Finish,
}

// SAFETY: threads only read A, B and the bias, and write disjoint rows of C.
unsafe impl Sync for Job {}

impl Job {
    /// Returns whether the transposed product is faster. Registers span columns of C; with few columns they better
    /// span rows, unless A then needs transposing, and also where rows are few and B would need transposing.
    fn is_better_transposed(&self, tile: Tile) -> bool {
        let side_by_side = self.c_strides[1] == 1;
        (!side_by_side && self.c_strides[0] == 1)
            || (self.columns <= tile.columns / 4 && self.rows >= tile.columns && self.a.across == 1)
            || (self.rows <= 2 && self.columns > tile.rows && self.b.across != 1)
    }

    /// Returns whether registers span the depth, because few columns leave most of a tile unused. This must not
    /// depend on the number of rows, because it determines the order of a sum.
    fn is_dots(&self) -> bool {
        self.columns <= MOST_COLUMNS && self.depth > 1 && self.a.along == 1
    }

    fn run_dots(&self, compute: &Compute, tile: Tile) {
        with_buffer(&RIGHT_PANELS, self.columns * self.depth, |columns| {
            for (index, column) in columns.chunks_exact_mut(self.depth).enumerate() {
                for (step, number) in column.iter_mut().enumerate() {
                    // SAFETY: B has this many columns and steps of the depth.
                    *number = unsafe { *self.b.data.add(index * self.b.across + step * self.b.along) };
                }
            }
            let right = Right { data: columns.as_ptr(), strides: [1, self.depth] };
            self.run_rows(compute, tile, |rows| {
                // SAFETY: the block lies within the matrices; the columns of B are contiguous.
                unsafe { compute_dots(compute.isa(), &self.block(tile, rows, &right)) }
            });
        });
    }

    /// Returns the same product as `C' = B' A'`.
    fn transposed(self) -> Self {
        let bias = match self.finish.bias {
            BiasAt::None => BiasAt::None,
            BiasAt::Rows(bias) => BiasAt::Columns(bias),
            BiasAt::Columns(bias) => BiasAt::Rows(bias),
        };
        let [row_stride, column_stride] = self.c_strides;
        Self {
            rows: self.columns,
            columns: self.rows,
            a: self.b,
            b: self.a,
            c_strides: [column_stride, row_stride],
            finish: Finish { bias, ..self.finish },
            ..self
        }
    }

    fn run(&self, compute: &Compute, tile: Tile) {
        for first_column in (0..self.columns).step_by(COLUMN_BLOCK) {
            let columns = COLUMN_BLOCK.min(self.columns - first_column);
            let mut first_step = 0;
            loop {
                let depth = DEPTH_BLOCK.min(self.depth - first_step);
                let part = self.part([first_column, columns], [first_step, depth]);
                part.run_packed(compute, tile);
                first_step += depth;
                if first_step >= self.depth {
                    break;
                }
            }
        }
    }

    /// Returns the part of some columns and some steps of the depth. The previous content of C counts in the first
    /// part of the depth only, bias and activation in the last.
    fn part(&self, [first_column, columns]: [usize; 2], [first_step, depth]: [usize; 2]) -> Self {
        let mut finish = self.finish;
        // SAFETY: the part lies within the matrices.
        unsafe {
            if let BiasAt::Columns(bias) = finish.bias {
                finish.bias = BiasAt::Columns(bias.add(first_column));
            }
            if first_step > 0 {
                finish.beta = 1.0;
            }
            if first_step + depth < self.depth {
                finish = Finish { bias: BiasAt::None, activation: Activation::Identity, ..finish };
            }
            // Without depth the factors are not read, and may be empty.
            let step = |source: Source, across: usize| Source {
                data: source.data.wrapping_add(first_step * source.along + across * source.across),
                ..source
            };
            Self {
                rows: self.rows,
                columns,
                depth,
                a: step(self.a, 0),
                b: step(self.b, first_column),
                c: self.c.add(first_column * self.c_strides[1]),
                c_strides: self.c_strides,
                finish,
            }
        }
    }

    /// Packs B, unless it is read by so few rows that packing does not pay, and computes.
    fn run_packed(&self, compute: &Compute, tile: Tile) {
        let whole = self.columns / tile.columns * tile.columns;
        let in_place = self.b.across == 1 && self.rows <= 4 * tile.rows;
        let first_packed = if in_place { whole } else { 0 };
        let packed = self.columns - first_packed;
        let panels = packed.div_ceil(tile.columns) * tile.columns * self.depth;
        with_buffer(&RIGHT_PANELS, panels, |panels| {
            if first_packed > 0 {
                let direct = self.part([0, first_packed], [0, self.depth]);
                direct.run_tiles(compute, tile, self.b.data, [self.b.along, tile.columns]);
            }
            if packed > 0 {
                let rest = self.part([first_packed, packed], [0, self.depth]);
                if self.depth > 0 {
                    // SAFETY: B has `packed` columns from here on, and `depth` rows.
                    unsafe { pack(rest.b, packed, self.depth, tile.columns, panels) };
                }
                rest.run_tiles(compute, tile, panels.as_ptr(), [tile.columns, tile.columns * self.depth]);
            }
        });
    }

    fn run_tiles(&self, compute: &Compute, tile: Tile, b: *const f32, b_strides: [usize; 2]) {
        let right = Right { data: b, strides: b_strides };
        self.run_rows(compute, tile, |rows| self.run_piece(compute.isa(), tile, rows, &right));
    }

    /// Runs all rows in pieces, given by first row and count, on the threads of the pool.
    fn run_rows(&self, compute: &Compute, tile: Tile, run: impl Fn([usize; 2]) + Sync) {
        // Every piece reads all of B once: with many rows pieces are large, with few they are small for an even
        // distribution.
        let piece = tile.rows * if self.rows > 384 { 24 } else { 8 };
        let work = |index: usize| {
            let first = index * piece;
            run([first, piece.min(self.rows - first)]);
        };
        let pieces = self.rows.div_ceil(piece);
        if self.rows.saturating_mul(self.columns).saturating_mul(self.depth) < PARALLEL_FROM {
            (0..pieces).for_each(work);
        } else {
            compute.pool().run(pieces, work);
        }
    }

    /// Returns the block of some rows, with A unpacked.
    fn block(&self, tile: Tile, [first, rows]: [usize; 2], b: &Right) -> Block {
        let mut finish = self.finish;
        // SAFETY: the piece lies within C and within the bias.
        let c = unsafe {
            if let BiasAt::Rows(bias) = finish.bias {
                finish.bias = BiasAt::Rows(bias.add(first));
            }
            self.c.add(first * self.c_strides[0])
        };
        Block {
            rows,
            columns: self.columns,
            depth: self.depth,
            a: self.a.data.wrapping_add(first * self.a.across),
            a_strides: [self.a.across, self.a.along, self.a.across * tile.rows],
            b: b.data,
            b_strides: b.strides,
            c,
            c_strides: self.c_strides,
            finish,
        }
    }

    /// Packs A, unless its rows are contiguous, or its columns are and so few columns of B read them that packing
    /// does not pay.
    fn run_piece(&self, isa: Isa, tile: Tile, [first, rows]: [usize; 2], b: &Right) {
        let block = self.block(tile, [first, rows], b);
        let is_read_often = self.columns > 4 * tile.columns;
        let in_place = self.a.along == 1 || (self.a.across == 1 && !is_read_often);
        if in_place || self.depth == 0 {
            // SAFETY: the block lies within the matrices, and B is readable in whole tiles.
            return unsafe { compute_block(isa, &block) };
        }
        with_buffer(&LEFT_PANELS, rows.div_ceil(tile.rows) * tile.rows * self.depth, |panels| {
            // SAFETY: A has these rows and `depth` columns; the block then reads the panels instead.
            unsafe {
                pack(Source { data: block.a, ..self.a }, rows, self.depth, tile.rows, panels);
                let a_strides = [1, tile.rows, tile.rows * self.depth];
                compute_block(isa, &Block { a: panels.as_ptr(), a_strides, ..block });
            }
        });
    }
}

/// B in the form that the inner loop reads.
struct Right {
    data: *const f32,
    strides: [usize; 2],
}

// SAFETY: threads only read it.
unsafe impl Sync for Right {}
