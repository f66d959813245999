//! Symmetric positive definite systems, dense and small.

/// Solves `matrix * x = right` in place by Cholesky's decomposition; `matrix` has `right.len()` rows, of which the lower triangle is
/// read. Returns `false` if the matrix is not positive definite.
pub(crate) fn solve_in_place(matrix: &mut [f64], right: &mut [f64]) -> bool {
    let size = right.len();
    for row in 0..size {
        for column in 0..=row {
            let (begin, other) = (row * size, column * size);
            let sum: f64 = (0..column).map(|at| matrix[begin + at] * matrix[other + at]).sum();
            let rest = matrix[begin + column] - sum;
            if row == column {
                if rest.is_nan() || rest <= 0.0 {
                    return false;
                }
                matrix[begin + row] = rest.sqrt();
            } else {
                matrix[begin + column] = rest / matrix[other + column];
            }
        }
    }
    for row in 0..size {
        let sum: f64 = (0..row).map(|at| matrix[row * size + at] * right[at]).sum();
        right[row] = (right[row] - sum) / matrix[row * size + row];
    }
    for row in (0..size).rev() {
        let sum: f64 = (row + 1..size).map(|at| matrix[at * size + row] * right[at]).sum();
        right[row] = (right[row] - sum) / matrix[row * size + row];
    }
    true
}
