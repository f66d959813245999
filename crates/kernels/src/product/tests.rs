use std::sync::Arc;

use opendr_engine::Random;
use proptest::prelude::*;

use super::*;
use crate::WorkerPool;

fn random(length: usize, seed: u64) -> Vec<f32> {
    let mut random = Random::new(seed);
    (0..length).map(|_| random.uniform(-1.0, 1.0)).collect()
}

/// Returns every instruction set of this machine, on one thread and on three.
fn computes() -> Vec<Compute> {
    let pools = [1, 3].map(|threads| Arc::new(WorkerPool::new(threads)));
    let with = |isa| pools.iter().map(move |pool| Compute::new(isa, Arc::clone(pool)));
    Isa::available().into_iter().flat_map(with).collect()
}

#[derive(Debug, Clone, Copy)]
struct Case {
    size: [usize; 3],
    /// Whether A, B and C are stored in column-major order.
    by_columns: [bool; 3],
    /// Gaps between neighbours, and between rows.
    gaps: [usize; 2],
    alpha: f32,
    beta: f32,
    bias: u8,
    activation: Activation,
}

fn strides([rows, columns]: [usize; 2], by_columns: bool, [gap, pitch]: [usize; 2]) -> [usize; 2] {
    let step = gap + 1;
    if by_columns { [step, rows * step + pitch] } else { [columns * step + pitch, step] }
}

fn extent([rows, columns]: [usize; 2], [down, right]: [usize; 2]) -> usize {
    if rows * columns == 0 { 0 } else { (rows - 1) * down + (columns - 1) * right + 1 }
}

fn reference(case: &Case, a: &[f32], b: &[f32], c: &[f32], bias: &[f32], at: [[usize; 2]; 3]) -> Vec<f64> {
    let [m, n, k] = case.size;
    let mut result: Vec<f64> = c.iter().map(|&value| f64::from(value)).collect();
    for i in 0..m {
        for j in 0..n {
            let product = |p: usize| {
                f64::from(a[i * at[0][0] + p * at[0][1]]) * f64::from(b[p * at[1][0] + j * at[1][1]])
            };
            let sum: f64 = (0..k).map(product).sum();
            let place = i * at[2][0] + j * at[2][1];
            let mut value = if case.alpha == 0.0 { 0.0 } else { f64::from(case.alpha) * sum };
            if case.beta != 0.0 {
                value += f64::from(case.beta) * f64::from(c[place]);
            }
            value += match case.bias {
                1 => f64::from(bias[i]),
                2 => f64::from(bias[j]),
                _ => 0.0,
            };
            result[place] = match case.activation {
                Activation::Identity => value,
                Activation::Relu => value.max(0.0),
                Activation::Tanh => value.tanh(),
                Activation::Sigmoid => 1.0 / (1.0 + (-value).exp()),
            };
        }
    }
    result
}

fn check(case: Case, computes: &[Compute]) {
    let [m, n, k] = case.size;
    let shapes = [[m, k], [k, n], [m, n]];
    let at: [[usize; 2]; 3] = std::array::from_fn(|i| strides(shapes[i], case.by_columns[i], case.gaps));
    let [a, b, c] = [0, 1, 2].map(|i| random(extent(shapes[i], at[i]), 7 + i as u64));
    let bias = random(if case.bias == 1 { m } else { n }, 11);
    let expected = reference(&case, &a, &b, &c, &bias, at);
    let mut first: Option<(Isa, Vec<f32>)> = None;
    for compute in computes {
        let mut result = c.clone();
        let bias = match case.bias {
            1 => Bias::Rows(&bias),
            2 => Bias::Columns(&bias),
            _ => Bias::None,
        };
        let product = Product { alpha: case.alpha, beta: case.beta, bias, activation: case.activation };
        product.run(
            compute,
            Matrix::with_strides(&a, shapes[0], at[0]),
            Matrix::with_strides(&b, shapes[1], at[1]),
            MatrixMut::with_strides(&mut result, shapes[2], at[2]),
        );
        let tolerance = 4e-7 * (k as f64 + 4.0) * f64::from(case.alpha.abs().max(1.0));
        for (place, (&ours, &exact)) in result.iter().zip(&expected).enumerate() {
            let error = (f64::from(ours) - exact).abs();
            assert!(error <= tolerance, "{case:?} {} at {place}: {ours}, not {exact}", compute.isa());
        }
        match &first {
            Some((isa, bits)) if *isa == compute.isa() => {
                assert_eq!(bits, &result, "threads differ: {case:?}")
            }
            _ => first = Some((compute.isa(), result)),
        }
    }
}

fn cases() -> impl Strategy<Value = Case> {
    let side = prop_oneof![0..5usize, 1..40usize, 60..70usize];
    let activation = prop_oneof![
        Just(Activation::Identity),
        Just(Activation::Relu),
        Just(Activation::Tanh),
        Just(Activation::Sigmoid)
    ];
    let size = [side.clone(), side.clone(), side];
    let factor = prop_oneof![Just(0.0f32), Just(1.0), Just(-0.5)];
    (size, any::<[bool; 3]>(), [0..2usize, 0..4usize], factor.clone(), factor, 0..3u8, activation).prop_map(
        |(size, by_columns, gaps, alpha, beta, bias, activation)| Case {
            size,
            by_columns,
            gaps,
            alpha,
            beta,
            bias,
            activation,
        },
    )
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 256, failure_persistence: None, ..ProptestConfig::default() })]
    #[test]
    fn equals_plain_loops(case in cases()) {
        let computes: Vec<Compute> =
            Isa::available().into_iter().map(|isa| Compute::new(isa, Arc::new(WorkerPool::new(1)))).collect();
        check(case, &computes);
    }
}

#[test]
fn large_products_do_not_depend_on_threads() {
    let computes = computes();
    let plain = Case {
        size: [0; 3],
        by_columns: [false; 3],
        gaps: [0, 0],
        alpha: 1.0,
        beta: 0.0,
        bias: 2,
        activation: Activation::Tanh,
    };
    for size in [[130, 97, 300], [97, 1050, 13], [520, 40, 64], [1, 600, 1030], [257, 2, 600]] {
        for by_columns in [[false; 3], [true, false, false], [false, true, false], [false, false, true]] {
            check(Case { size, by_columns, ..plain }, &computes);
            check(Case { size, by_columns, beta: -0.5, bias: 1, ..plain }, &computes);
        }
    }
}

/// A row has the same bits alone and in a batch.
#[test]
fn rows_do_not_depend_on_the_batch() {
    for (compute, columns) in computes().iter().flat_map(|compute| [1, 2, 3, 4, 33].map(|n| (compute, n))) {
        let (a, b) = (random(100 * 70, 1), random(70 * columns, 2));
        let mut all = vec![0.0; 100 * columns];
        let (left, right) = (Matrix::new(&a, 100, 70), Matrix::new(&b, 70, columns));
        Product::new().run(compute, left, right, MatrixMut::new(&mut all, 100, columns));
        for (row, expected) in a.chunks(70).zip(all.chunks(columns)) {
            let mut one = vec![0.0; columns];
            Product::new().run(compute, Matrix::new(row, 1, 70), right, MatrixMut::new(&mut one, 1, columns));
            assert_eq!(one, expected, "{} {columns}", compute.isa());
        }
    }
}

#[test]
fn nan_and_infinity_propagate() {
    for compute in computes() {
        for (m, n) in [(1, 1), (7, 19), (40, 3), (33, 65)] {
            let (mut a, mut b) = (random(m * 5, 1), random(5 * n, 2));
            a[(m - 1) * 5 + 2] = f32::NAN;
            b[n - 1] = f32::INFINITY;
            let mut c = vec![f32::NAN; m * n];
            Product::new().activation(Activation::Relu).run(
                &compute,
                Matrix::new(&a, m, 5),
                Matrix::new(&b, 5, n),
                MatrixMut::new(&mut c, m, n),
            );
            for i in 0..m {
                for j in 0..n {
                    let value = c[i * n + j];
                    match (i + 1 == m, j + 1 == n) {
                        (true, _) => assert!(value.is_nan(), "{value} at {i}, {j} of {m} x {n}"),
                        (false, true) => assert_eq!(value.is_infinite(), a[i * 5] > 0.0, "{value} {i}"),
                        (false, false) => assert!(value.is_finite(), "{value} at {i}, {j} of {m} x {n}"),
                    }
                }
            }
        }
    }
}

#[test]
fn a_broadcast_factor_may_have_no_stride() {
    let mut c = [0.0; 12];
    let ones = Matrix::with_strides(&[1.0], [3, 100], [0, 0]);
    let twos = Matrix::with_strides(&[2.0], [100, 4], [0, 0]);
    Product::new().run(&Compute::single(), ones, twos, MatrixMut::new(&mut c, 3, 4));
    assert_eq!(c, [200.0; 12]);
}

#[test]
#[should_panic(expected = "shapes of A, B and C do not match")]
fn shapes_that_do_not_fit_are_refused() {
    let mut c = [0.0; 4];
    let factor = Matrix::new(&[0.0; 6], 2, 3);
    Product::new().run(&Compute::single(), factor, factor, MatrixMut::new(&mut c, 2, 2));
}

#[test]
#[should_panic(expected = "overlap")]
fn results_that_overlap_are_refused() {
    MatrixMut::with_strides(&mut [0.0; 10], [3, 4], [2, 1]);
}
