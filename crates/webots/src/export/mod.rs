//! Worlds of `opendr-simulation` as world files of Webots, so that results can be checked in another simulator.

mod acrobot;
mod cart_pole;
mod corridor;
mod episode;
mod link;
mod mountain_car;
mod node;
mod pendulum;
mod quad_track;
mod rotation;
#[cfg(test)]
mod tests;
mod world;

use opendr_engine::params::ParamMap;
use opendr_engine::{Error, Result};
use opendr_simulation::Registry;

use episode::Episode;

/// Returns the world file (`.wbt`) of an episode: the bodies of the environment in their initial state, and a robot with the
/// controller `<extern>` that has its motors and sensors.
///
/// Cart-pole, pendulum and acrobot are simulated by Webots. Mountain cars, the drone of the corridor and the quadrotor have no
/// physics in Webots: a controller places them.
///
/// # Errors
/// Returns `NotFound` for an unknown environment, `InvalidParam` for wrong parameters, `Unsupported` for an environment without a
/// world.
pub fn export(id: &str, params: &ParamMap, seed: u64) -> Result<String> {
    let registration = Registry::builtin().get(id)?;
    let episode = Episode::begin(registration, params, seed)?;
    let world = match registration.id() {
        "CartPole-v1" => cart_pole::world(&episode),
        "Pendulum-v1" => pendulum::world(&episode),
        "Acrobot-v1" => acrobot::world(&episode),
        "MountainCar-v0" | "MountainCarContinuous-v0" => mountain_car::world(&episode),
        "QuadTrack-v1" => quad_track::world(&episode)?,
        corridor if corridor.starts_with("UavDepthCorridor-") => corridor::world(&episode)?,
        other => {
            let reason = match other.starts_with("SphereView-") {
                true => "the textures of its subjects cannot be exported yet",
                false => "its bodies are not exported yet",
            };
            return Err(Error::unsupported(format!("{other} has no world for Webots: {reason}")));
        }
    };
    Ok(world.to_string())
}
