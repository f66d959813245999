//! Eigenvectors of small symmetric matrices.

/// Returns the eigenvalues of a symmetric matrix and, as rows, their eigenvectors, by Jacobi's rotations.
pub(super) fn eigen<const N: usize>(mut matrix: [[f64; N]; N]) -> ([f64; N], [[f64; N]; N]) {
    let mut vectors = [[0.0; N]; N];
    (0..N).for_each(|at| vectors[at][at] = 1.0);
    for _ in 0..50 {
        let off: f64 = (0..N)
            .flat_map(|row| (0..row).map(move |column| (row, column)))
            .map(|(row, column)| matrix[row][column].powi(2))
            .sum();
        if off < 1e-300 {
            break;
        }
        for p in 0..N {
            for q in p + 1..N {
                if matrix[p][q] == 0.0 {
                    continue;
                }
                let theta = (matrix[q][q] - matrix[p][p]) / (2.0 * matrix[p][q]);
                let tangent = theta.signum() / (theta.abs() + (theta * theta + 1.0).sqrt());
                let cosine = 1.0 / (tangent * tangent + 1.0).sqrt();
                let sine = tangent * cosine;
                for row in &mut matrix {
                    let (a, b) = (row[p], row[q]);
                    (row[p], row[q]) = (cosine * a - sine * b, sine * a + cosine * b);
                }
                for at in 0..N {
                    let (a, b) = (matrix[p][at], matrix[q][at]);
                    (matrix[p][at], matrix[q][at]) = (cosine * a - sine * b, sine * a + cosine * b);
                    let (a, b) = (vectors[p][at], vectors[q][at]);
                    (vectors[p][at], vectors[q][at]) = (cosine * a - sine * b, sine * a + cosine * b);
                }
            }
        }
    }
    (std::array::from_fn(|at| matrix[at][at]), vectors)
}
