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
mod sphere_view;
#[cfg(test)]
mod tests;
mod world;
mod world_files;

use opendr_engine::params::ParamMap;
use opendr_engine::{Error, Result};
use opendr_simulation::Registry;
use opendr_simulation::sphere_view::Subject;

use episode::Episode;
pub use world_files::WorldFiles;

/// Returns the world of an episode as files of Webots: the bodies of the environment in their initial state, and a robot with the
/// controller `<extern>` that has its motors and sensors.
///
/// Cart-poles, pendulums, acrobots and the bodies of planar manipulation are simulated by Webots. Mountain cars, the drone of the
/// corridor, the quadrotor, mobile robots and the camera of active perception have no physics in Webots: a controller places them.
///
/// # Errors
/// Returns `NotFound` for an unknown environment, `InvalidParam` for wrong parameters, `Unsupported` for an environment without a
/// world.
pub fn export(id: &str, params: &ParamMap, seed: u64) -> Result<WorldFiles> {
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
        id => match Subject::ALL.into_iter().find(|subject| subject.id() == id) {
            Some(subject) => sphere_view::world(&episode, subject)?,
            None => return Err(Error::unsupported(format!("{id} has no world for Webots"))),
        },
    };
    Ok(world.into_files())
}
