//! A quadrotor that tracks a moving reference while its plant changes in flight: the benchmark of online fine-tuning.
//!
//! The plant is a rigid body with rotors of first order, an attitude loop, actuation delay, drag and Dryden turbulence
//! (MIL-F-8785C, low altitude). The controller receives the tracking error of a delayed, noisy state estimate and commands an
//! acceleration. At a chosen time the mass, the drag, the wind or the strength of one motor changes.

mod environment;
mod episode;
mod estimator;
mod options;
mod plant;
mod reference;
#[cfg(test)]
mod tests;
mod tracking;
mod turbulence;
mod view;

pub use environment::QuadTrack;
pub use options::{QuadTrackParams, ReferencePath};

/// Seconds of one step of the environment.
pub const CONTROL_PERIOD: f64 = 0.01;
/// Steps of the physics in one of the environment.
const SUBSTEPS: usize = 4;
/// Seconds of one step of the physics.
const TIME_STEP: f64 = CONTROL_PERIOD / SUBSTEPS as f64;
/// Largest acceleration that can be commanded along an axis, m/s^2.
pub const MAX_ACCELERATION: f32 = 8.0;
/// Numbers of an observation.
pub const OBSERVATION_LEN: usize = 17;
/// Longest delay that can be set, in steps of the environment.
const LONGEST_DELAY: usize = 10;
