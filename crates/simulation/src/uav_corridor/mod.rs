//! A drone with a depth camera among obstacles: OpenDR's end-to-end planning without Webots and ROS.
//!
//! World, sensor, actions and rewards have the parameters of OpenDR's `UAVDepthPlanningEnv` and `ObstacleRandomizer`
//! (Ugurlu, Pham and Kayacan, Sim-to-real deep reinforcement learning for safe end-to-end planning of aerial robots,
//! 2022). Positions in metres, x along the corridor, y to the left, z up.

mod clearance;
mod compact;
mod controllers;
mod environment;
mod flight;
mod flight_memory;
mod flight_memory_wrapper;
mod foresight;
mod foresight_samples;
mod lookahead;
mod map_raster;
mod options;
mod picture;
mod quadrotor;
mod range_camera;
mod sight;
mod surroundings;
mod surroundings_samples;
#[cfg(test)]
mod tests;
mod variants;
mod way_costs;
mod world;

pub use clearance::CorridorClearance;
pub use compact::{CompactController, CompactCorridor, compact_space};
pub use controllers::{
    CorridorController, ObservationController, PotentialField, PurePursuit, ReactiveController,
    StraightController, YawTracker,
};
pub use environment::UavDepthCorridor;
pub use flight_memory::FlightMemory;
pub use flight_memory_wrapper::FlightMemoryWrapper;
pub use foresight::Foresight;
pub use foresight_samples::ForesightSamples;
pub use options::{CorridorForm, CorridorOptions, UavDepthCorridorParams};
pub use sight::CorridorObservation;
pub use surroundings::Surroundings;
pub use surroundings_samples::SurroundingsSamples;

pub(crate) use variants::registrations;
pub use variants::{Compact, Dense, Discrete, Dynamic, Noisy};
pub use world::CorridorWorld;

/// Pixels of the depth camera in each direction.
pub const SIDE: usize = 64;
/// Range of the depth camera, in metres.
pub const RANGE: f32 = 15.0;
/// Tangent of half the camera's field of view of 45 degrees.
const HALF_WIDTH: f32 = 0.414_213_57;
/// Radius of the drone as a ball, in metres.
const RADIUS: f32 = 0.25;
/// Height of the camera above the drone's centre, in metres.
const CAMERA_HEIGHT: f32 = 0.1;
/// x of the start and of the finish, in metres.
const START: f32 = -10.0;
const FINISH: f32 = 20.0;
/// Desired height of the flight, in metres.
const HEIGHT: f32 = 2.5;
/// Half width of the track, in metres.
const HALF_TRACK: f32 = 5.0;
/// Distance of the target ahead of the drone, in metres.
const TARGET: f32 = 5.0;
/// Maximum change of heading and of yaw: 22.5 degrees.
const TURN: f64 = std::f64::consts::PI / 8.0;
