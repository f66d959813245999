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
    /// Designs the regulator from matrices by rows: A is `states x states`, B is `states x inputs`, Q and R are symmetric.
    ///
    /// The discrete algebraic Riccati equation is solved by the structure-preserving doubling algorithm (Chu, Fan and Lin, 2005),
    /// which converges quadratically.
    ///
    /// # Errors
    /// `InvalidParam` for matrices that do not fit, an R that is singular, and a plant that Q and R do not stabilise.
    pub fn design(states: usize, inputs: usize, a: &[f64], b: &[f64], q: &[f64], r: &[f64]) -> Result<Self> {
        if !(1..=LARGEST).contains(&states) || !(1..=LARGEST).contains(&inputs) {
            return Err(Error::invalid_param(format!(
                "{states} states and {inputs} inputs; give 1 to {LARGEST} of each"
            )));
        }
        let (a, b) = (Dense::new(states, states, a)?, Dense::new(states, inputs, b)?);
        let (q, r) = (Dense::new(states, states, q)?, Dense::new(inputs, inputs, r)?);
        let singular =
            || Error::invalid_param("R is singular; give every input a positive weight of its own");
        let spread = r.solve(&b.transposed()).map(|right| b.times(&right)).ok_or_else(singular)?;
        let cost = riccati(&a, spread, &q)?;
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

/// The stabilising solution of `P = Q + Aᵀ P (1 + G P)^-1 A` with `G = B R^-1 Bᵀ`.
fn riccati(a: &Dense, spread: Dense, q: &Dense) -> Result<Dense> {
    let unstabilised = || {
        Error::invalid_param(
            "no feedback stabilises this plant at this cost; give every unstable state an input and a weight",
        )
    };
    let size = a.rows;
    let mut identity = Dense { numbers: vec![0.0; size * size], ..*a };
    (0..size).for_each(|at| identity.numbers[at * size + at] = 1.0);
    let (mut a, mut g, mut h) = (a.clone(), spread, q.clone());
    for _ in 0..DOUBLINGS {
        let w = identity.plus(&g.times(&h), 1.0);
        let moved = w.solve(&a).ok_or_else(unstabilised)?;
        let spread = w.solve(&g).ok_or_else(unstabilised)?;
        g = g.plus(&a.times(&spread).times(&a.transposed()), 1.0);
        let added = a.transposed().times(&h).times(&moved);
        h = h.plus(&added, 1.0);
        a = a.times(&moved);
        if !h.largest().is_finite() {
            return Err(unstabilised());
        }
        if added.largest() <= 1e-14 * h.largest() {
            return match a.largest() < 1e-3 {
                true => Ok(h),
                false => Err(unstabilised()),
            };
        }
    }
    Err(unstabilised())
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
        assert!(Lqr::design(1, 1, &[2.0], &[0.0], &[1.0], &[1.0]).is_err(), "nothing moves it");
        assert!(Lqr::design(1, 1, &[1.0], &[1.0], &[1.0], &[0.0]).is_err(), "R is singular");
        assert!(Lqr::design(2, 1, &[1.0], &[1.0], &[1.0], &[1.0]).is_err(), "sizes");
        assert!(Lqr::design(1, 1, &[f64::NAN], &[1.0], &[1.0], &[1.0]).is_err());
    }
}
