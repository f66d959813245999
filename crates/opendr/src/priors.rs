//! Priors: controllers by name, that policies start from, command, learn from, or are guarded by.

use opendr_engine::Result;
use opendr_rl::prior::Prior;

use crate::registry::registry;

/// Returns the priors of this process: those of this build, then those that the program registered.
pub fn priors() -> Vec<Prior> {
    // The parameters of its learners name them.
    registry();
    Prior::all()
}

/// Returns the newest version of a prior of this process.
///
/// # Errors
/// As [`Prior::newest`].
pub fn prior(name: &str) -> Result<Prior> {
    registry();
    Prior::newest(name)
}

#[cfg(test)]
mod tests {
    use opendr_simulation::Registry;

    use super::*;

    /// The environment of each prior of `opendr-control`; `opendr-rl` tests its own.
    const ENVIRONMENTS: [(&str, &str); 6] = [
        ("cart-pole-lqr", "CartPole-v1"),
        ("pendulum-lqr", "Pendulum-v1"),
        ("planar-push-teacher", "PlanarPush-v1"),
        ("planar-peg-teacher", "PlanarPeg-v1"),
        ("quad-track-pid", "QuadTrack-v1"),
        ("quad-track-lqr", "QuadTrack-v1"),
    ];

    #[test]
    fn the_learners_know_the_controllers_of_control() {
        registry();
        for (name, environment) in ENVIRONMENTS {
            let prior = Prior::newest(name).unwrap();
            assert!(prior.description().contains(environment), "{name}: {}", prior.description());
            for id in Registry::builtin().ids() {
                let environment_of = opendr_simulation::make(id).unwrap();
                let made = prior.controller(&environment_of.spec().observation);
                assert_eq!(made.is_ok(), id == environment, "{name} in {id}");
            }
        }
        let names: Vec<_> = priors().iter().map(|prior| prior.id().name.clone()).collect();
        for own in opendr_control::priors() {
            assert_eq!(names.iter().filter(|name| **name == own.id().name).count(), 1, "{names:?}");
        }
    }
}
