//! Environments by name: those of [`crate::simulation`], and robots in other simulators, which are connected to when they are created.

use opendr_engine::Result;
use opendr_engine::params::ParamMap;
use opendr_simulation::{RegisteredSource, Registration, Registry};

/// Returns the environments of other simulators.
pub fn external() -> Vec<Registration> {
    #[cfg(feature = "webots")]
    let external = vec![opendr_webots::registration()];
    #[cfg(not(feature = "webots"))]
    let external = Vec::new();
    external
}

/// Returns the entry of an environment.
///
/// # Errors
/// `NotFound` for an unknown id.
pub fn registration(id: &str) -> Result<Registration> {
    match outside(id) {
        Some(registration) => Ok(registration),
        None => Registry::builtin().get(id).cloned(),
    }
}

/// Selects an environment, with `params` over its defaults.
///
/// # Errors
/// `NotFound` for an unknown id; for a built-in environment, `InvalidParam` for unknown parameters or values out of range.
pub fn source(id: &str, params: &ParamMap) -> Result<RegisteredSource> {
    match outside(id) {
        Some(registration) => Ok(RegisteredSource::of(registration, params)),
        None => RegisteredSource::new(id, params),
    }
}

fn outside(id: &str) -> Option<Registration> {
    external().into_iter().find(|registration| registration.id() == id)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn environments_inside_and_outside_are_found() {
        assert_eq!(registration("CartPole").unwrap().id(), "CartPole-v1");
        assert!(registration("Walker-v0").is_err());
        for outside in external() {
            assert!(registration(outside.id()).is_ok() && !outside.fields().is_empty());
        }
    }
}
