//! Eigenvalues and eigenvectors of small symmetric matrices.

/// Maximum number of sweeps; convergence is quadratic.
const SWEEPS: usize = 50;

/// Returns the eigenvalues of a symmetric matrix of `size` rows, in no order, and the eigenvectors as columns of a
/// matrix stored in rows (Jacobi's method).
pub fn eigen_from_symmetric(mut matrix: Vec<f64>, size: usize) -> (Vec<f64>, Vec<f64>) {
    let mut vectors: Vec<f64> =
        (0..size * size).map(|at| if at / size == at % size { 1.0 } else { 0.0 }).collect();
    for _ in 0..SWEEPS {
        let aside: f64 =
            (0..size * size).filter(|at| at / size != at % size).map(|at| matrix[at].powi(2)).sum();
        let diagonal: f64 = (0..size).map(|at| matrix[at * size + at].powi(2)).sum();
        if aside <= 1e-30 * diagonal {
            break;
        }
        for p in 0..size {
            for q in p + 1..size {
                rotate(&mut matrix, &mut vectors, size, p, q);
            }
        }
    }
    ((0..size).map(|at| matrix[at * size + at]).collect(), vectors)
}

/// Rotates the plane of axes `p` and `q` so that their off-diagonal element becomes 0.
fn rotate(matrix: &mut [f64], vectors: &mut [f64], size: usize, p: usize, q: usize) {
    let element = matrix[p * size + q];
    if element == 0.0 {
        return;
    }
    let ratio = (matrix[q * size + q] - matrix[p * size + p]) / (2.0 * element);
    let tangent = ratio.signum() / (ratio.abs() + ratio.hypot(1.0));
    let cosine = 1.0 / tangent.hypot(1.0);
    let sine = tangent * cosine;
    let turn = |of: &mut [f64], a: usize, b: usize| {
        (of[a], of[b]) = (cosine * of[a] - sine * of[b], sine * of[a] + cosine * of[b]);
    };
    for row in 0..size {
        turn(matrix, row * size + p, row * size + q);
        turn(vectors, row * size + p, row * size + q);
    }
    for column in 0..size {
        turn(matrix, p * size + column, q * size + column);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use opendr_engine::Random;

    #[test]
    fn vectors_and_values_make_the_matrix() {
        let mut random = Random::new(1);
        for size in 1..9 {
            let half: Vec<f64> = (0..size * size).map(|_| random.normal()).collect();
            let matrix: Vec<f64> =
                (0..size * size).map(|at| half[at] + half[at % size * size + at / size]).collect();
            let (values, vectors) = eigen_from_symmetric(matrix.clone(), size);
            for (at, expected) in matrix.iter().enumerate() {
                let (row, column) = (at / size, at % size);
                let product: f64 =
                    (0..size).map(|k| vectors[row * size + k] * values[k] * vectors[column * size + k]).sum();
                assert!((product - expected).abs() < 1e-12, "{size}: {product} {expected}");
            }
        }
    }
}
