/// A read-only matrix: a slice, a shape, and the strides of rows and columns.
#[derive(Debug, Clone, Copy)]
pub struct Matrix<'a> {
    pub(crate) data: &'a [f32],
    pub(crate) shape: Shape,
}

/// A mutable matrix.
#[derive(Debug)]
pub struct MatrixMut<'a> {
    pub(crate) data: &'a mut [f32],
    pub(crate) shape: Shape,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Shape {
    pub(crate) rows: usize,
    pub(crate) columns: usize,
    pub(crate) row_stride: usize,
    pub(crate) column_stride: usize,
}

impl Shape {
    fn row_major(rows: usize, columns: usize) -> Self {
        Self { rows, columns, row_stride: columns, column_stride: 1 }
    }

    pub(crate) fn transposed(self) -> Self {
        Self {
            rows: self.columns,
            columns: self.rows,
            row_stride: self.column_stride,
            column_stride: self.row_stride,
        }
    }

    /// Returns the required length of the slice; `None` when it overflows.
    fn extent(self) -> Option<usize> {
        if self.rows == 0 || self.columns == 0 {
            return Some(0);
        }
        let down = (self.rows - 1).checked_mul(self.row_stride)?;
        let right = (self.columns - 1).checked_mul(self.column_stride)?;
        down.checked_add(right)?.checked_add(1)
    }

    fn fits(self, length: usize) -> bool {
        self.extent().is_some_and(|extent| extent <= length)
    }

    /// Returns whether no two elements overlap. Other ways of interleaving rows are not recognised, and rejected.
    fn is_injective(self) -> bool {
        let Self { rows, columns, row_stride, column_stride } = self;
        let apart = |outer: usize, outer_stride: usize, inner: usize, inner_stride: usize| {
            (inner <= 1 || inner_stride > 0)
                && (outer <= 1 || outer_stride > inner.saturating_sub(1) * inner_stride)
        };
        rows == 0
            || columns == 0
            || apart(rows, row_stride, columns, column_stride)
            || apart(columns, column_stride, rows, row_stride)
    }
}

impl<'a> Matrix<'a> {
    /// Creates a row-major matrix.
    ///
    /// # Panics
    /// When `data` is too short.
    pub fn new(data: &'a [f32], rows: usize, columns: usize) -> Self {
        Self::of(data, Shape::row_major(rows, columns))
    }

    /// Creates a matrix whose element (i, j) is `data[i * row_stride + j * column_stride]`; strides may be 0.
    ///
    /// # Panics
    /// When `data` is too short.
    pub fn with_strides(
        data: &'a [f32],
        [rows, columns]: [usize; 2],
        [row_stride, column_stride]: [usize; 2],
    ) -> Self {
        Self::of(data, Shape { rows, columns, row_stride, column_stride })
    }

    fn of(data: &'a [f32], shape: Shape) -> Self {
        assert!(shape.fits(data.len()), "a slice of {} numbers is too short for {shape:?}", data.len());
        Self { data, shape }
    }

    /// Returns the transpose, without moving elements.
    #[must_use]
    pub fn transposed(self) -> Self {
        Self { data: self.data, shape: self.shape.transposed() }
    }
}

impl<'a> MatrixMut<'a> {
    /// Creates a row-major matrix.
    ///
    /// # Panics
    /// When `data` is too short.
    pub fn new(data: &'a mut [f32], rows: usize, columns: usize) -> Self {
        Self::of(data, Shape::row_major(rows, columns))
    }

    /// Creates a matrix whose element (i, j) is `data[i * row_stride + j * column_stride]`.
    ///
    /// # Panics
    /// When `data` is too short, or elements overlap.
    pub fn with_strides(
        data: &'a mut [f32],
        [rows, columns]: [usize; 2],
        [row_stride, column_stride]: [usize; 2],
    ) -> Self {
        Self::of(data, Shape { rows, columns, row_stride, column_stride })
    }

    fn of(data: &'a mut [f32], shape: Shape) -> Self {
        assert!(shape.fits(data.len()), "a slice of {} numbers is too short for {shape:?}", data.len());
        assert!(shape.is_injective(), "elements of {shape:?} overlap");
        Self { data, shape }
    }

    /// Returns the transpose, without moving elements.
    #[must_use]
    pub fn transposed(self) -> Self {
        Self { shape: self.shape.transposed(), data: self.data }
    }
}
