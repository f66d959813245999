//! Prior of `Pendulum-v1`.

use opendr_engine::environment::{Controller, Snapshot, Space, StateReader};
use opendr_engine::{Error, Result};
use opendr_rl::prior::{BoxedController, Prior, PriorId, unread_space};
use opendr_simulation::make;

use crate::lqr::Lqr;

const NAME: &str = "pendulum-lqr";

/// Gymnasium's pendulum: angular acceleration by the sine of the angle and by the torque.
const BY_SINE: f64 = 15.0;
const BY_TORQUE: f64 = 3.0;
const PERIOD: f64 = 0.05;
const MAX_TORQUE: f64 = 2.0;
/// Cosine of the angle within which the motor can hold the pendulum.
const UPRIGHT: f32 = 0.9;

pub(super) fn priors() -> Vec<Prior> {
    let lqr = Prior::new(NAME, 1, |space: &Space| -> Result<BoxedController> {
        if *space != make("Pendulum-v1")?.spec().observation {
            return Err(unread_space(NAME, space));
        }
        let swing_up = Prior::find(&PriorId { name: "pendulum-energy".to_owned(), version: 1 })?;
        Ok(Box::new(PendulumLqr { regulator: regulator()?, swing_up: swing_up.controller(space)? }))
    });
    vec![lqr.about(
        "LQR about the upright for the environment's own cost, swung up by pendulum-energy, in Pendulum-v1",
    )]
}

/// Returns the regulator of a semi-implicit Euler step about the upright, for the cost of the environment.
fn regulator() -> Result<Lqr> {
    let a = [1.0 + BY_SINE * PERIOD * PERIOD, PERIOD, BY_SINE * PERIOD, 1.0];
    let b = [BY_TORQUE * PERIOD * PERIOD, BY_TORQUE * PERIOD];
    Lqr::design(2, 1, &a, &b, &[1.0, 0.0, 0.0, 0.1], &[0.001])
}

/// The motor is too weak to lift the pendulum at once: elsewhere, the energy law acts.
struct PendulumLqr {
    regulator: Lqr,
    swing_up: BoxedController,
}

impl Controller for PendulumLqr {
    fn reset(&mut self) {
        self.swing_up.reset();
    }

    fn act(&mut self, observation: &[f32], action: &mut [f32]) -> Result<()> {
        match (observation, &mut *action) {
            ([cosine, sine, speed], [torque]) if *cosine > UPRIGHT => {
                let error = [-f64::from(sine.atan2(*cosine)), -f64::from(*speed)];
                let mut command = [0.0];
                self.regulator.command(&error, &mut command);
                *torque = command[0].clamp(-MAX_TORQUE, MAX_TORQUE) as f32;
                match torque.is_finite() {
                    true => Ok(()),
                    false => Err(Error::invalid_input(format!(
                        "an observation {observation:?}; give finite numbers"
                    ))),
                }
            }
            _ => self.swing_up.act(observation, action),
        }
    }

    // The energy law depends on the present observation alone.
    fn save_state(&self, _: &mut Snapshot) -> Result<()> {
        Ok(())
    }

    fn load_state(&mut self, _: &mut StateReader<'_>) -> Result<()> {
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use opendr_engine::environment::ResetOptions;
    use opendr_rl::{EvaluationProtocol, evaluate_controller};

    use super::*;

    /// The gains of SciPy 1.17 (`solve_discrete_are`) for the same matrices.
    #[test]
    fn the_gains_are_scipys() {
        let lqr = regulator().unwrap();
        assert!((lqr.gain()[0] - 19.69321655).abs() < 1e-6 && (lqr.gain()[1] - 5.26250008).abs() < 1e-6);
    }

    #[test]
    fn the_pendulum_is_swung_up_and_held() {
        let mut pendulum = make("Pendulum-v1").unwrap();
        let space = pendulum.spec().observation.clone();
        let mut controller = priors()[0].controller(&space).unwrap();
        let protocol = EvaluationProtocol { episodes: 100, ..EvaluationProtocol::default() };
        let report = evaluate_controller(&mut *controller, &mut *pendulum, &protocol, &|_| None).unwrap();
        assert!(report.mean_return > -180.0, "{}", report.mean_return);
        let (mut observation, mut action) = ([0.0; 3], [0.0]);
        pendulum.reset(Some(4), &ResetOptions::new(), &mut observation).unwrap();
        for _ in 0..199 {
            controller.act(&observation, &mut action).unwrap();
            pendulum.step(&action, &mut observation).unwrap();
        }
        assert!(observation[0] > 0.9999 && observation[2].abs() < 0.01, "{observation:?}");
        assert!(controller.act(&[0.95, 0.1, f32::NAN], &mut action).is_err());
        assert!(controller.act(&[0.95, 0.1], &mut action).is_err());
    }
}
