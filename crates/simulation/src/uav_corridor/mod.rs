//! A drone with a depth camera between obstacles: OpenDR's end-to-end planning without Webots and ROS.
//!
//! World, sensor, actions and rewards have the numbers of OpenDR's `UAVDepthPlanningEnv` and `ObstacleRandomizer`
//! (Ugurlu, Pham and Kayacan, Sim-to-real deep reinforcement learning for safe end-to-end planning of aerial robots,
//! 2022). Positions in metres, x along the corridor, y to the left, z up.

mod controllers;
mod environment;
mod flight;
mod flight_memory;
mod lookahead;
mod map_raster;
mod options;
mod picture;
mod quadrotor;
mod range_camera;
mod remembered;
mod sight;
mod surroundings;
mod surroundings_samples;
mod surveyed;
#[cfg(test)]
mod tests;
mod variants;
mod way_costs;
mod world;

pub use controllers::{BySight, CorridorController, PotentialField, Reactive, Straight, YawAccount};
pub use environment::UavDepthCorridor;
pub use flight_memory::FlightMemory;
pub use options::{CorridorForm, CorridorOptions, UavDepthCorridorParams};
pub use remembered::Remembered;
pub use sight::CorridorSight;
pub use surroundings::Surroundings;
pub use surroundings_samples::SurroundingsSamples;
pub use surveyed::{BySurvey, Surveyed, surveyed_space};
pub(crate) use variants::registrations;
pub use variants::{Dense, Discrete, Dynamic, Noisy};
pub use world::CorridorWorld;

/// Pixels of the depth camera in each direction.
pub const SIDE: usize = 64;
/// How far the depth camera sees, metres.
pub const RANGE: f32 = 15.0;
/// The tangent of half the camera's angle of view, 45 degrees.
const HALF_WIDTH: f32 = 0.414_213_57;
/// The drone is a ball of this radius, metres.
const RADIUS: f32 = 0.25;
/// Where the camera is above the drone's centre, metres.
const CAMERA_HEIGHT: f32 = 0.1;
/// Where a flight begins, and where it is over: x.
const START: f32 = -10.0;
const FINISH: f32 = 20.0;
/// The height at which the drone is to fly.
const HEIGHT: f32 = 2.5;
/// Farther to the side than this the drone is off the track.
const HALF_TRACK: f32 = 5.0;
/// How far ahead of the drone the target moves.
const TARGET: f32 = 5.0;
/// Largest change of heading and of yaw: 22.5 degrees.
const TURN: f64 = std::f64::consts::PI / 8.0;
