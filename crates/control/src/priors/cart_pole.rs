//! Prior of `CartPole-v1`.

use opendr_engine::Result;
use opendr_engine::environment::Space;
use opendr_rl::prior::{BoxedController, Prior, unread_space};
use opendr_simulation::make;

use crate::actuator::Actuator;
use crate::feedback::ObservationLqr;
use crate::lqr::Lqr;

const NAME: &str = "cart-pole-lqr";

/// Gymnasium's cart and pole.
const GRAVITY: f64 = 9.8;
const POLE_MASS: f64 = 0.1;
const TOTAL_MASS: f64 = 1.1;
const HALF_LENGTH: f64 = 0.5;
const FORCE: f64 = 10.0;
const PERIOD: f64 = 0.02;

pub(super) fn priors() -> Vec<Prior> {
    let lqr = Prior::new(NAME, 1, |space: &Space| -> Result<BoxedController> {
        if *space != make("CartPole-v1")?.spec().observation {
            return Err(unread_space(NAME, space));
        }
        let pushes = Actuator::Levels(vec![-FORCE, FORCE]);
        Ok(Box::new(ObservationLqr::new(regulator()?, vec![0, 1, 2, 3], vec![0.0; 4], vec![0.0], pushes)?))
    });
    vec![lqr.about("LQR about the upright; the nearer of the two pushes to its force, in CartPole-v1")]
}

/// Returns A and B of a step about the upright, with the states position, velocity, angle and angular velocity.
fn linear_model() -> ([f64; 16], [f64; 4]) {
    // Florian, Correct equations for the dynamics of the cart-pole system, 2007, at an angle of 0; explicit Euler steps.
    let inertia = HALF_LENGTH * (4.0 / 3.0 - POLE_MASS / TOTAL_MASS);
    let [tip_by_angle, tip_by_force] = [GRAVITY / inertia, -1.0 / (TOTAL_MASS * inertia)];
    let reaction = POLE_MASS * HALF_LENGTH / TOTAL_MASS;
    let [push_by_angle, push_by_force] =
        [-reaction * tip_by_angle, 1.0 / TOTAL_MASS - reaction * tip_by_force];
    #[rustfmt::skip]
    let a = [
        1.0, PERIOD, 0.0,                    0.0,
        0.0, 1.0,    PERIOD * push_by_angle, 0.0,
        0.0, 0.0,    1.0,                    PERIOD,
        0.0, 0.0,    PERIOD * tip_by_angle,  1.0,
    ];
    (a, [0.0, PERIOD * push_by_force, 0.0, PERIOD * tip_by_force])
}

/// Returns the regulator. Only two forces exist, so that the weight of the force sets how soon the sign changes, not how large it is.
fn regulator() -> Result<Lqr> {
    let (a, b) = linear_model();
    let mut q = [0.0; 16];
    for (at, weight) in [1.0, 1.0, 10.0, 1.0].into_iter().enumerate() {
        q[5 * at] = weight;
    }
    Lqr::design(4, 1, &a, &b, &q, &[0.1])
}

#[cfg(test)]
mod tests {
    use opendr_engine::environment::ResetOptions;
    use opendr_rl::{EvaluationProtocol, evaluate_controller};

    use super::*;

    #[test]
    fn the_linear_model_is_that_of_the_environment() {
        let mut cart = make("CartPole-v1").unwrap();
        let (a, b) = linear_model();
        let (mut before, mut after) = ([0.0; 4], [0.0; 4]);
        for seed in 0..20 {
            cart.reset(Some(seed), &ResetOptions::new(), &mut before).unwrap();
            let push = seed % 2;
            cart.step(&[push as f32], &mut after).unwrap();
            let force = if push == 1 { FORCE } else { -FORCE };
            for row in 0..4 {
                let moved: f64 = (0..4).map(|at| a[4 * row + at] * f64::from(before[at])).sum();
                let off = (moved + b[row] * force - f64::from(after[row])).abs();
                // A push moves the velocities by 0.2 and 0.3; a mass that is wrong by one percent, by a hundredth of these.
                assert!(off < 5e-4, "state {row}: {off}");
            }
        }
    }

    /// The gains of SciPy 1.17 (`solve_discrete_are`) for the same matrices.
    #[test]
    fn the_gains_are_scipys() {
        let scipy = [-2.78438439, -5.32082376, -46.43747495, -12.04769661];
        for (gain, wanted) in regulator().unwrap().gain().iter().zip(scipy) {
            assert!((gain - wanted).abs() < 1e-6, "{gain} {wanted}");
        }
    }

    #[test]
    fn the_pole_stands_for_whole_episodes() {
        let mut cart = make("CartPole-v1").unwrap();
        let space = cart.spec().observation.clone();
        let mut controller = priors()[0].controller(&space).unwrap();
        let protocol = EvaluationProtocol { episodes: 50, ..EvaluationProtocol::default() };
        let report = evaluate_controller(&mut *controller, &mut *cart, &protocol, &|_| None).unwrap();
        assert_eq!((report.mean_return, report.std_return), (500.0, 0.0));
    }
}
