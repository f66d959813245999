//! Linear-quadratic regulators.

use opendr_engine::{Error, Result};

use crate::matrix::Dense;

/// The optimal state feedback `u = K x` for `x' = A x + B u` in discrete time and the cost `sum of xᵀ Q x + uᵀ R u`, with the sign
/// that suits an error as state (reference less state): the command drives it to zero.
#[derive(Debug, Clone, PartialEq)]
pub struct Lqr {
    gain: Dense,
    cost: Dense,
}

/// Largest number of states or inputs.
const LARGEST: usize = 256;
/// Doublings of the horizon: 2^64 steps.
const DOUBLINGS: usize = 64;

impl Lqr {
    /// Designs the regulator from matrices by rows: A is `states x states`, B is `states x inputs`, Q and R are symmetric, Q is
    /// positive semidefinite and R positive definite.
    ///
    /// The discrete algebraic Riccati equation is solved by the structure-preserving doubling algorithm (Chu, Fan and Lin, 2005),
    /// which converges quadratically.
    ///
    /// # Errors
    /// `InvalidParam` for matrices that do not fit together or have another definiteness, and where no regulator has a finite cost:
    /// (A, B) is not stabilisable, or Q has no weight on a state that does not decay by itself.
    pub fn design(states: usize, inputs: usize, a: &[f64], b: &[f64], q: &[f64], r: &[f64]) -> Result<Self> {
        if !(1..=LARGEST).contains(&states) || !(1..=LARGEST).contains(&inputs) {
            return Err(Error::invalid_param(format!(
                "{states} states and {inputs} inputs; give 1 to {LARGEST} of each"
            )));
        }
        let (a, b) = (Dense::new(states, states, a)?, Dense::new(states, inputs, b)?);
        let (q, r) = (Dense::new(states, states, q)?, Dense::new(inputs, inputs, r)?);
        check_weights(&q, &r)?;
        let singular =
            || Error::invalid_param("R is singular; give every input a positive weight of its own");
        let spread = r.solve(&b.transposed()).map(|right| b.times(&right)).ok_or_else(singular)?;
        let cost = riccati(&a, &spread, &q).ok_or_else(|| no_regulator(&a, &spread))?;
        let weight = r.plus(&b.transposed().times(&cost).times(&b), 1.0);
        let gain = weight.solve(&b.transposed().times(&cost).times(&a)).ok_or_else(singular)?;
        Ok(Self { gain, cost })
    }

    /// Designs a regulator of one axis whose state is an error and its rate, driven by an acceleration that is held for `period`
    /// seconds.
    ///
    /// # Errors
    /// As [`Self::design`].
    pub fn double_integrator(period: f64, error: f64, rate: f64, effort: f64) -> Result<Self> {
        let a = [1.0, period, 0.0, 1.0];
        let b = [0.5 * period * period, period];
        Self::design(2, 1, &a, &b, &[error, 0.0, 0.0, rate], &[effort])
    }

    /// Returns the number of states.
    pub fn states(&self) -> usize {
        self.gain.columns
    }

    /// Returns the number of inputs.
    pub fn inputs(&self) -> usize {
        self.gain.rows
    }

    /// Returns the gain K by rows, `inputs x states`.
    pub fn gain(&self) -> &[f64] {
        &self.gain.numbers
    }

    /// Returns the solution of the Riccati equation by rows: `xᵀ P x` is the cost to come.
    pub fn cost(&self) -> &[f64] {
        &self.cost.numbers
    }

    /// Writes the command for a state.
    ///
    /// # Panics
    /// Where a length is another than in the design.
    pub fn command(&self, state: &[f64], command: &mut [f64]) {
        assert_eq!([state.len(), command.len()], [self.gain.columns, self.gain.rows], "of another plant");
        for (command, gains) in command.iter_mut().zip(self.gain.numbers.chunks_exact(state.len())) {
            *command = gains.iter().zip(state).map(|(gain, part)| gain * part).sum();
        }
    }
}

/// Checks symmetry and definiteness of the weights.
fn check_weights(q: &Dense, r: &Dense) -> Result<()> {
    for (name, weights) in [("Q", q), ("R", r)] {
        if let Some((row, column)) = weights.asymmetry() {
            return Err(Error::invalid_param(format!(
                "{name} has {} in row {row}, column {column} and {} in row {column}, column {row}; give a symmetric matrix",
                weights.at(row, column),
                weights.at(column, row)
            )));
        }
    }
    if !q.is_positive_semidefinite() {
        return Err(Error::invalid_param(
            "Q is not positive semidefinite: some deviation of the state would have a negative cost; give weights of at least 0",
        ));
    }
    if !r.is_positive_definite() {
        return Err(Error::invalid_param(
            "R is not positive definite: some command would have no cost; give every input a positive weight of its own",
        ));
    }
    Ok(())
}

/// Why a plant with positive semidefinite weights has no regulator.
#[cold]
fn no_regulator(a: &Dense, spread: &Dense) -> Error {
    // With a weight on every state, only an input can be missing.
    match riccati(a, spread, &Dense::identity(a.rows)) {
        Some(_) => Error::invalid_param(
            "Q has no weight on a state that does not decay by itself, so that its cost is not bounded by the feedback; give it a weight",
        ),
        None => Error::invalid_param(
            "(A, B) is not stabilisable: no input moves a state that does not decay by itself; correct A or B, or leave that state out",
        ),
    }
}

/// The stabilising solution of `P = Q + Aᵀ P (1 + G P)^-1 A` with `G = B R^-1 Bᵀ`; none where there is none.
fn riccati(a: &Dense, spread: &Dense, q: &Dense) -> Option<Dense> {
    let identity = Dense::identity(a.rows);
    let (mut a, mut g, mut h) = (a.clone(), spread.clone(), q.clone());
    for _ in 0..DOUBLINGS {
        let w = identity.plus(&g.times(&h), 1.0);
        let (moved, spread) = (w.solve(&a)?, w.solve(&g)?);
        g = g.plus(&a.times(&spread).times(&a.transposed()), 1.0);
        let added = a.transposed().times(&h).times(&moved);
        h = h.plus(&added, 1.0);
        a = a.times(&moved);
        if !h.largest().is_finite() {
            return None;
        }
        if added.largest() <= 1e-14 * h.largest() {
            return (a.largest() < 1e-3).then_some(h);
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    /// For one state the equation is quadratic: p = q + a²p - (abp)²/(r + b²p).
    #[test]
    fn one_state_has_the_closed_solution() {
        for (a, b, q, r) in [(1.0, 1.0, 1.0, 1.0), (1.2, 0.5, 2.0, 0.3), (0.7, 2.0, 0.1, 5.0)] {
            let lqr = Lqr::design(1, 1, &[a], &[b], &[q], &[r]).unwrap();
            let half = r * (1.0 - a * a) - b * b * q;
            let p: f64 = (-half + (half * half + 4.0 * b * b * q * r).sqrt()) / (2.0 * b * b);
            assert!((lqr.cost()[0] - p).abs() < 1e-12 * p, "{} {p}", lqr.cost()[0]);
            assert!((lqr.gain()[0] - a * b * p / (r + b * b * p)).abs() < 1e-12);
        }
        // The golden ratio, a textbook's case.
        let golden = Lqr::design(1, 1, &[1.0], &[1.0], &[1.0], &[1.0]).unwrap();
        assert!((golden.cost()[0] - (1.0 + 5.0_f64.sqrt()) / 2.0).abs() < 1e-13);
    }

    /// In continuous time a double integrator with weights (1, 0) and 1 has the gains 1 and the square root of 2.
    #[test]
    fn a_double_integrator_has_the_textbooks_gains() {
        let lqr = Lqr::double_integrator(1e-4, 1.0, 0.0, 1.0).unwrap();
        assert!((lqr.gain()[0] - 1.0).abs() < 1e-3 && (lqr.gain()[1] - 2.0_f64.sqrt()).abs() < 1e-3);
    }

    /// The solution satisfies the equation, and its cost is that of the simulated closed loop.
    #[test]
    fn the_cost_is_that_of_the_closed_loop() {
        let a = [1.0, 0.1, 0.0, 0.02, 0.97, 0.1, -0.1, 0.05, 1.05];
        let (b, q) = ([0.0, 0.1, 0.02, 0.0, 0.1, 0.2], [2.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.5]);
        let r = [0.3, 0.1, 0.1, 0.4];
        let lqr = Lqr::design(3, 2, &a, &b, &q, &r).unwrap();
        let quadratic = |weights: &[f64], x: &[f64]| -> f64 {
            let rows = weights.chunks_exact(x.len()).zip(x);
            rows.map(|(row, own)| own * row.iter().zip(x).map(|(w, x)| w * x).sum::<f64>()).sum()
        };
        let (mut x, mut cost) = (vec![1.0, -2.0, 0.5], 0.0);
        let promised = quadratic(lqr.cost(), &x);
        for _ in 0..5000 {
            let mut u = [0.0; 2];
            lqr.command(&x, &mut u);
            u.iter_mut().for_each(|part| *part = -*part);
            cost += quadratic(&q, &x) + quadratic(&r, &u);
            x = (0..3)
                .map(|row| {
                    let own: f64 = (0..3).map(|at| a[3 * row + at] * x[at]).sum();
                    own + (0..2).map(|at| b[2 * row + at] * u[at]).sum::<f64>()
                })
                .collect();
        }
        assert!((cost / promised - 1.0).abs() < 1e-9, "{cost} {promised}");
    }

    #[test]
    fn what_has_no_solution_is_refused() {
        let message = |a: &[f64], b: &[f64], q: &[f64], r: &[f64]| {
            let [states, inputs] = [a.len().isqrt(), r.len().isqrt()];
            let error = Lqr::design(states, inputs, a, b, q, r).unwrap_err();
            assert_eq!(error.kind(), opendr_engine::ErrorKind::InvalidParam, "{error}");
            error.to_string()
        };
        let stabilisable = "(A, B) is not stabilisable";
        assert!(message(&[2.0], &[0.0], &[1.0], &[1.0]).contains(stabilisable), "nothing moves it");
        // The second state grows, and only the first has an input; one that decays needs none.
        let (b, q) = ([1.0, 0.0], [1.0, 0.0, 0.0, 1.0]);
        assert!(message(&[0.5, 0.0, 0.0, 1.1], &b, &q, &[1.0]).contains(stabilisable));
        assert!(message(&[0.5, 0.0, 0.0, 1.0], &b, &q, &[1.0]).contains(stabilisable), "on the unit circle");
        assert!(Lqr::design(2, 1, &[1.5, 0.0, 0.0, 0.9], &b, &q, &[1.0]).is_ok());
        assert!(message(&[2.0], &[1.0], &[0.0], &[1.0]).contains("Q has no weight on a state"));
        assert!(message(&[1.0], &[1.0], &[1.0], &[0.0]).contains("R is not positive definite"));
        assert!(message(&[1.0], &[1.0], &[-1.0], &[1.0]).contains("Q is not positive semidefinite"));
        let a = [1.0, 0.1, 0.0, 1.0];
        let rotated = [1.0, 2.0, 2.0, 1.0];
        assert!(message(&a, &[0.0, 0.1], &rotated, &[1.0]).contains("Q is not positive semidefinite"));
        let lopsided = message(&a, &[0.0, 0.1], &[1.0, 0.5, 0.0, 1.0], &[1.0]);
        assert!(lopsided.contains("Q has 0.5 in row 0, column 1 and 0 in row 1, column 0"), "{lopsided}");
        assert!(Lqr::design(2, 1, &a, &[0.0, 0.1], &[1.0, 1.0, 1.0, 1.0], &[1.0]).is_ok(), "of rank 1");
        assert!(Lqr::design(2, 1, &[1.0], &[1.0], &[1.0], &[1.0]).is_err(), "sizes");
        assert!(Lqr::design(1, 1, &[f64::NAN], &[1.0], &[1.0], &[1.0]).is_err());
    }
}
