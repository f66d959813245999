//! Built-in priors.

use opendr_engine::environment::Space;
use opendr_engine::{Error, Result};
use opendr_simulation::uav_corridor::{
    CompactController, CorridorController, CorridorObservation, ObservationController, PotentialField,
    PurePursuit, ReactiveController, compact_space,
};

use super::named_prior::{BoxedController, Prior};

/// The share of its headings that the weak reactive controller flies.
const WEAK: f32 = 0.6;

/// Returns the priors of this crate.
pub(super) fn builtin() -> Vec<Prior> {
    vec![
        Prior::new("corridor-reactive", 1, |space| corridor(ReactiveController::default(), space))
            .about("flies to the free columns of the depth image nearest to the target, in UavDepthCorridor"),
        Prior::new("corridor-reactive-weak", 1, |space| {
            corridor(ReactiveController::with_heading_share(WEAK), space)
        })
        .about("the same with 0.6 of its headings, for measurements of what a weak prior is worth"),
        Prior::new("corridor-potential-field", 1, |space| corridor(PotentialField::default(), space))
            .about("potential field of target and depth image, in UavDepthCorridor"),
        Prior::new("corridor-pure-pursuit", 1, |space| corridor(PurePursuit::default(), space))
            .about("pure pursuit of the middle line, without regard to obstacles, in UavDepthCorridor"),
        Prior::new("pendulum-energy", 1, |space| match space.len() {
            3 => Ok(Box::new(pendulum)),
            _ => Err(unread("pendulum-energy", space)),
        })
        .about("swings up by the energy and balances by a PD law, in Pendulum-v1"),
    ]
}

/// Returns a controller of the corridor for observations of `space`.
fn corridor<C: CorridorController + Send + 'static>(controller: C, space: &Space) -> Result<BoxedController> {
    if *space == compact_space()? {
        return Ok(Box::new(CompactController::new(controller)));
    }
    match CorridorObservation::default().read(space, &vec![0.0; space.len()]) {
        Ok(()) => Ok(Box::new(ObservationController::new(controller, space.clone()))),
        Err(_) => Err(unread("this controller of UavDepthCorridor", space)),
    }
}

fn unread(name: &str, space: &Space) -> Error {
    Error::unsupported(format!(
        "{name} reads no observations {space}; select a prior of this environment (\"opendr sim priors\" lists them)"
    ))
}

/// Swing-up by energy (Astrom and Furuta, Swinging up a pendulum by energy control, 2000) and a PD law near the top.
fn pendulum(observation: &[f32], action: &mut [f32]) -> Result<()> {
    let ([cosine, sine, speed], [torque]) = (observation, action) else {
        return Err(Error::invalid_input(format!(
            "{} numbers are no observation of Pendulum-v1, which has 3; or its action has not 1",
            observation.len()
        )));
    };
    // Gymnasium's pendulum: length and mass 1, gravity 10, moment of inertia 1/3.
    let energy = speed * speed / 6.0 + 5.0 * (cosine - 1.0);
    *torque = match *cosine > 0.9 {
        true => (-12.0 * sine.atan2(*cosine) - 3.0 * speed).clamp(-2.0, 2.0),
        false => (-2.0 * energy * speed.signum()).clamp(-2.0, 2.0),
    };
    Ok(())
}

#[cfg(test)]
mod tests {
    use opendr_engine::ErrorKind;
    use opendr_engine::environment::Step;
    use opendr_simulation::make;

    use super::*;
    use crate::{EvaluationProtocol, evaluate_controller};

    #[test]
    fn priors_refuse_spaces_that_they_do_not_read() {
        let cart = make("CartPole-v1").unwrap().spec().observation.clone();
        for prior in builtin() {
            let error = prior.controller(&cart).err().unwrap();
            assert_eq!(error.kind(), ErrorKind::Unsupported, "{}", prior.id().name);
            assert!(!prior.description().is_empty());
        }
    }

    #[test]
    fn the_pendulum_is_swung_up() {
        let mut pendulum = make("Pendulum-v1").unwrap();
        let space = pendulum.spec().observation.clone();
        let mut prior = Prior::newest("pendulum-energy").unwrap().controller(&space).unwrap();
        let protocol = EvaluationProtocol { episodes: 20, ..EvaluationProtocol::default() };
        let success = |_: &Step| None;
        let report = evaluate_controller(&mut *prior, &mut *pendulum, &protocol, &success).unwrap();
        assert!(report.mean_return > -400.0, "{}", report.mean_return);
    }
}
