//! Built-in priors.

use opendr_engine::environment::{Controller, Snapshot, Space, StateReader};
use opendr_engine::{Error, Result};
use opendr_simulation::uav_corridor::{
    CompactController, CorridorController, CorridorObservation, ObservationController, PotentialField,
    PurePursuit, ReactiveController, compact_space,
};

use super::named_prior::{BoxedController, Prior, unread_space};
use super::{BoxedCommanded, CommandLaw, CommandedController};

/// The share of its headings that the weak reactive controller flies.
const WEAK: f32 = 0.6;

/// Returns the priors of this crate.
pub(super) fn builtin() -> Vec<Prior> {
    vec![
        Prior::new("corridor-reactive", 1, |space| corridor(ReactiveController::default(), space))
            .about("flies to the free columns of the depth image nearest to the target, in UavDepthCorridor")
            .with_commands(commanded_corridor),
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
            _ => Err(unread_space("pendulum-energy", space)),
        })
        .about("swings up by the energy and balances by a PD law, in Pendulum-v1")
        .with_commands(|space| match space.len() {
            3 => Ok(Box::new(CommandLaw::new(Space::symmetric(&[1.0; 2]), 1, commanded_pendulum))),
            _ => Err(unread_space("pendulum-energy", space)),
        }),
    ]
}

/// Returns a controller of the corridor for observations of `space`.
fn corridor<C: CorridorController + Send + 'static>(controller: C, space: &Space) -> Result<BoxedController> {
    if *space == compact_space()? {
        return Ok(Box::new(CompactController::new(controller)));
    }
    match CorridorObservation::default().read(space, &vec![0.0; space.len()]) {
        Ok(()) => Ok(Box::new(ObservationController::new(controller, space.clone()))),
        Err(_) => Err(unread_space("this controller of UavDepthCorridor", space)),
    }
}

/// Numbers of a command to the reactive controller, and of its action.
const AXES: usize = 2;

/// The reactive controller with commands of reference and gain.
struct CommandedCorridor<C> {
    controller: C,
    commands: Space,
}

/// Returns the commanded reactive controller for observations of `space`.
fn commanded_corridor(space: &Space) -> Result<BoxedCommanded> {
    let (commands, reactive) = (Space::symmetric(&[1.0; AXES]), ReactiveController::default());
    if *space == compact_space()? {
        return Ok(Box::new(CommandedCorridor { controller: CompactController::new(reactive), commands }));
    }
    match CorridorObservation::default().read(space, &vec![0.0; space.len()]) {
        Ok(()) => {
            let controller = ObservationController::new(reactive, space.clone());
            Ok(Box::new(CommandedCorridor { controller, commands }))
        }
        Err(_) => Err(unread_space("this controller of UavDepthCorridor", space)),
    }
}

impl<C: Controller + AsMut<ReactiveController> + Send> CommandedController for CommandedCorridor<C> {
    fn commands(&self) -> &Space {
        &self.commands
    }

    fn actions(&self) -> usize {
        AXES
    }

    fn reset(&mut self) {
        self.controller.reset();
    }

    fn follow(&mut self, observation: &[f32], command: &[f32], action: &mut [f32]) -> Result<()> {
        let command = command.as_array().ok_or_else(|| {
            Error::invalid_input(format!(
                "a command of {} numbers; give {AXES}, reference and gain",
                command.len()
            ))
        })?;
        self.controller.as_mut().follow(*command);
        self.controller.act(observation, action)
    }

    fn save_state(&self, snapshot: &mut Snapshot) -> Result<()> {
        self.controller.save_state(snapshot)
    }

    fn load_state(&mut self, state: &mut StateReader<'_>) -> Result<()> {
        self.controller.load_state(state)
    }
}

/// Swing-up by energy (Astrom and Furuta, Swinging up a pendulum by energy control, 2000) and a PD law near the top.
fn pendulum(observation: &[f32], action: &mut [f32]) -> Result<()> {
    commanded_pendulum(observation, &[0.0; 2], action)
}

/// The same with two commands in [-1, 1]: the energy of the swing-up above that of standing upright, in joules, and the angle to balance
/// at, in half radians.
fn commanded_pendulum(observation: &[f32], command: &[f32], action: &mut [f32]) -> Result<()> {
    let ([cosine, sine, speed], [surplus, lean], [torque]) = (observation, command, action) else {
        return Err(Error::invalid_input(format!(
            "{} numbers are no observation of Pendulum-v1, which has 3; or its action has not 1",
            observation.len()
        )));
    };
    // Gymnasium's pendulum: length and mass 1, gravity 10, moment of inertia 1/3.
    let energy = speed * speed / 6.0 + 5.0 * (cosine - 1.0) - surplus;
    *torque = match *cosine > 0.9 {
        true => (-12.0 * (sine.atan2(*cosine) - 0.5 * lean) - 3.0 * speed).clamp(-2.0, 2.0),
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
