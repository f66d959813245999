use proptest::prelude::*;

use super::*;

type Matrix = Vec<Vec<f64>>;

fn product(a: &Matrix, b: &Matrix) -> Matrix {
    let cell = |row: &Vec<f64>, column: usize| row.iter().zip(b).map(|(x, line)| x * line[column]).sum();
    a.iter().map(|row| (0..b[0].len()).map(|column| cell(row, column)).collect()).collect()
}

fn transposed(a: &Matrix) -> Matrix {
    (0..a[0].len()).map(|column| a.iter().map(|row| row[column]).collect()).collect()
}

fn diagonal(numbers: &[f64]) -> Matrix {
    let cell = |row: usize, column: usize| if row == column { numbers[row] } else { 0.0 };
    (0..numbers.len()).map(|row| (0..numbers.len()).map(|column| cell(row, column)).collect()).collect()
}

/// Inverts by elimination with pivots.
fn inverse(a: &Matrix) -> Matrix {
    let count = a.len();
    let mut rows: Matrix =
        a.iter().zip(diagonal(&vec![1.0; count])).map(|(row, unit)| [row.clone(), unit].concat()).collect();
    for at in 0..count {
        let pivot = (at..count).max_by(|a, b| rows[*a][at].abs().total_cmp(&rows[*b][at].abs())).unwrap();
        rows.swap(at, pivot);
        let by = rows[at][at];
        rows[at].iter_mut().for_each(|cell| *cell /= by);
        for other in (0..count).filter(|other| *other != at) {
            let by = rows[other][at];
            let pivot = rows[at].clone();
            rows[other].iter_mut().zip(pivot).for_each(|(cell, pivot)| *cell -= by * pivot);
        }
    }
    rows.into_iter().map(|row| row[count..].to_vec()).collect()
}

/// SORT's filter of seven variables in matrix form: four measured, of which three have velocities.
struct Textbook {
    state: Matrix,
    covariance: Matrix,
}

const START: [f64; 7] = [10.0, 10.0, 10.0, 10.0, 1e4, 1e4, 1e4];
const PROCESS: [f64; 7] = [1.0, 1.0, 1.0, 1.0, 0.01, 0.01, 1e-4];
const MEASUREMENT: [f64; 4] = [1.0, 1.0, 10.0, 10.0];

impl Textbook {
    fn new(measured: [f64; 4]) -> Self {
        let state = measured.iter().chain(&[0.0; 3]).map(|number| vec![*number]).collect();
        Self { state, covariance: diagonal(&START) }
    }

    fn step(&mut self, measured: Option<[f64; 4]>) {
        let mut transition = diagonal(&[1.0; 7]);
        (0..3).for_each(|at| transition[at][at + 4] = 1.0);
        self.state = product(&transition, &self.state);
        let moved = product(&product(&transition, &self.covariance), &transposed(&transition));
        let add = |a: &Matrix, b: &Matrix, sign: f64| -> Matrix {
            let row = |(a, b): (&Vec<f64>, &Vec<f64>)| a.iter().zip(b).map(|(a, b)| a + sign * b).collect();
            a.iter().zip(b).map(row).collect()
        };
        self.covariance = add(&moved, &diagonal(&PROCESS), 1.0);
        let Some(measured) = measured else { return };
        let seen: Matrix = diagonal(&[1.0; 7])[..4].to_vec();
        let crossed = product(&self.covariance, &transposed(&seen));
        let spread = add(&product(&seen, &crossed), &diagonal(&MEASUREMENT), 1.0);
        let gain = product(&crossed, &inverse(&spread));
        let measured: Matrix = measured.iter().map(|number| vec![*number]).collect();
        let innovation = add(&measured, &product(&seen, &self.state), -1.0);
        self.state = add(&self.state, &product(&gain, &innovation), 1.0);
        self.covariance = add(&self.covariance, &product(&gain, &transposed(&crossed)), -1.0);
    }
}

proptest! {
    /// A filter of seven variables with diagonal noise equals three pairs and one single.
    #[test]
    fn as_the_textbook_filter(
        first in prop::array::uniform4(-1e3..1e3),
        steps in prop::collection::vec(prop::option::weighted(0.7, prop::array::uniform4(-1e3..1e3)), 1..30),
    ) {
        let mut textbook = Textbook::new(first);
        let mut moving: Vec<_> =
            (0..3).map(|at| ConstantVelocity::new(first[at], [START[at], START[at + 4]])).collect();
        let mut ratio = Constant::new(first[3], START[3]);
        for measured in steps {
            textbook.step(measured);
            for (at, axis) in moving.iter_mut().enumerate() {
                axis.predict([PROCESS[at], PROCESS[at + 4]]);
                if let Some(measured) = measured {
                    axis.update(measured[at], MEASUREMENT[at]);
                }
            }
            ratio.predict(PROCESS[3]);
            if let Some(measured) = measured {
                ratio.update(measured[3], MEASUREMENT[3]);
            }
            let near = |a: f64, b: f64| (a - b).abs() <= 1e-7 * a.abs().max(1.0);
            for (at, axis) in moving.iter().enumerate() {
                prop_assert!(near(textbook.state[at][0], axis.position));
                prop_assert!(near(textbook.state[at + 4][0], axis.velocity));
                prop_assert!(near(textbook.covariance[at][at], axis.covariance[0]));
                prop_assert!(near(textbook.covariance[at][at + 4], axis.covariance[1]));
            }
            prop_assert!(near(textbook.state[3][0], ratio.value));
        }
    }
}

/// Computes two steps by hand, with fractions.
#[test]
fn by_hand() {
    let mut axis = ConstantVelocity::new(0.0, [10.0, 10_000.0]);
    axis.predict([1.0, 0.01]);
    assert_eq!(axis.covariance, [10_011.0, 10_000.0, 10_000.01]);
    axis.update(1.0, 1.0);
    assert_eq!((axis.position, axis.velocity), (10_011.0 / 10_012.0, 10_000.0 / 10_012.0));
    assert!((axis.covariance[2] - (10_000.01 - 1e8 / 10_012.0)).abs() < 1e-9);
    assert!(
        (axis.squared_distance(axis.position + 2.0, 1.0) - 4.0 / (10_011.0 / 10_012.0 + 1.0)).abs() < 1e-12
    );
}
