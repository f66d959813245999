//! Worlds of `opendr-simulation` as world files of Webots, so that results can be checked in another simulator.

mod acrobot;
mod cart_pole;
mod corridor;
mod episode;
mod gantry;
mod link;
mod mobile_manipulation;
mod mountain_car;
mod node;
mod object_search;
mod pendulum;
mod planar;
mod quad_track;
mod rotation;
mod solid;
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
/// Cart-poles, pendulums, acrobots and the bodies of planar manipulation are simulated by Webots. Mountain cars, the drone of the
/// corridor, the quadrotor and mobile robots have no physics in Webots: a controller places them.
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
        "PlanarPush-v1" => planar::push(&episode)?,
        "PlanarPeg-v1" => planar::peg(&episode)?,
        "PlanarGrasp-v1" => planar::grasp(&episode)?,
        search if search.starts_with("ObjectSearch2D-") => object_search::world(&episode)?,
        arm if arm.starts_with("MobileManip") => mobile_manipulation::world(&episode)?,
        corridor if corridor.starts_with("UavDepthCorridor-") => corridor::world(&episode)?,
        other => {
            let reason = "a world file has no place for the textures of its subjects";
            return Err(Error::unsupported(format!("{other} has no world for Webots: {reason}")));
        }
    };
    Ok(world.to_string())
}
