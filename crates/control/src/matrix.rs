//! Small dense matrices in double precision, for the design of controllers.

use opendr_engine::{Error, Result};

/// A matrix by rows.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Dense {
    pub rows: usize,
    pub columns: usize,
    pub numbers: Vec<f64>,
}

impl Dense {
    pub fn new(rows: usize, columns: usize, numbers: &[f64]) -> Result<Self> {
        if numbers.len() != rows * columns || rows == 0 || columns == 0 {
            return Err(Error::invalid_param(format!(
                "{} numbers for a matrix of {rows} x {columns}; give one for each place",
                numbers.len()
            )));
        }
        match numbers.iter().find(|number| !number.is_finite()) {
            None => Ok(Self { rows, columns, numbers: numbers.to_vec() }),
            Some(number) => Err(Error::invalid_param(format!("a matrix with {number}; give finite numbers"))),
        }
    }

    fn zeros(rows: usize, columns: usize) -> Self {
        Self { rows, columns, numbers: vec![0.0; rows * columns] }
    }

    pub fn identity(size: usize) -> Self {
        let mut identity = Self::zeros(size, size);
        (0..size).for_each(|at| identity.numbers[at * size + at] = 1.0);
        identity
    }

    pub fn at(&self, row: usize, column: usize) -> f64 {
        self.numbers[row * self.columns + column]
    }

    pub fn times(&self, other: &Self) -> Self {
        let mut product = Self::zeros(self.rows, other.columns);
        for row in 0..self.rows {
            for inner in 0..self.columns {
                for column in 0..other.columns {
                    product.numbers[row * other.columns + column] +=
                        self.at(row, inner) * other.at(inner, column);
                }
            }
        }
        product
    }

    pub fn transposed(&self) -> Self {
        let numbers =
            (0..self.columns).flat_map(|column| (0..self.rows).map(move |row| self.at(row, column)));
        Self { rows: self.columns, columns: self.rows, numbers: numbers.collect() }
    }

    /// This plus `factor` times another.
    pub fn plus(&self, other: &Self, factor: f64) -> Self {
        let numbers = self.numbers.iter().zip(&other.numbers).map(|(a, b)| a + factor * b).collect();
        Self { numbers, ..*self }
    }

    /// Returns the solution X of `self X = right` (Gaussian elimination with partial pivoting); none where this matrix is singular.
    pub fn solve(&self, right: &Self) -> Option<Self> {
        let (size, width) = (self.rows, right.columns);
        let (mut a, mut b) = (self.numbers.clone(), right.numbers.clone());
        for column in 0..size {
            let pivot = (column..size).max_by(|one, other| {
                a[one * size + column].abs().total_cmp(&a[other * size + column].abs())
            })?;
            if a[pivot * size + column].abs() < 1e-300 {
                return None;
            }
            (0..size).for_each(|at| a.swap(pivot * size + at, column * size + at));
            (0..width).for_each(|at| b.swap(pivot * width + at, column * width + at));
            for row in (0..size).filter(|row| *row != column) {
                let factor = a[row * size + column] / a[column * size + column];
                (column..size).for_each(|at| a[row * size + at] -= factor * a[column * size + at]);
                (0..width).for_each(|at| b[row * width + at] -= factor * b[column * width + at]);
            }
        }
        for row in 0..size {
            (0..width).for_each(|at| b[row * width + at] /= a[row * size + row]);
        }
        Some(Self { rows: size, columns: width, numbers: b })
    }

    /// Returns the first place above the diagonal whose number differs from the one across it.
    pub fn asymmetry(&self) -> Option<(usize, usize)> {
        let tolerance = 1e-9 * self.largest();
        let pairs = (0..self.rows).flat_map(|row| (row + 1..self.columns).map(move |column| (row, column)));
        let mut pairs =
            pairs.filter(|(row, column)| (self.at(*row, *column) - self.at(*column, *row)).abs() > tolerance);
        pairs.next()
    }

    /// Returns whether a symmetric matrix is positive definite: whether it has a Cholesky factor.
    pub fn is_positive_definite(&self) -> bool {
        let size = self.rows;
        let mut factor = Self::zeros(size, size);
        for column in 0..size {
            for row in column..size {
                let inner: f64 = (0..column).map(|at| factor.at(row, at) * factor.at(column, at)).sum();
                let rest = self.at(row, column) - inner;
                factor.numbers[row * size + column] = match row == column {
                    false => rest / factor.at(column, column),
                    // A remainder of rounding errors is zero.
                    true if rest > 1e-13 * self.at(row, row) => rest.sqrt(),
                    true => return false,
                };
            }
        }
        true
    }

    /// Returns whether a symmetric matrix is positive semidefinite, up to rounding errors of its largest number.
    pub fn is_positive_semidefinite(&self) -> bool {
        let largest = self.largest();
        largest == 0.0 || self.plus(&Self::identity(self.rows), 1e-10 * largest).is_positive_definite()
    }

    pub fn largest(&self) -> f64 {
        self.numbers.iter().fold(0.0, |most, number| most.max(number.abs()))
    }
}
