//! A T on a table that a pusher moves to a goal pose: a benchmark of imitation learning with contacts.
//!
//! The task is Push-T (Chi et al., Diffusion policy, 2023) in SI units: the T has the proportions of Push-T, 12 cm wide, and slides
//! quasi-statically with the friction of the table. [`PushTeacher`] demonstrates it: strokes planned with the same physics, and
//! between them ways around the T, left or right at random.

mod environment;
mod options;
mod stroke;
mod table;
mod teacher;
#[cfg(test)]
mod tests;
mod view;

pub use environment::PlanarPush;
pub use options::PlanarPushParams;
pub use teacher::PushTeacher;

/// Seconds of one step of the environment.
pub const CONTROL_PERIOD: f64 = 0.1;
/// Fastest motion of the pusher, m/s: an action of 1.
pub const MAX_SPEED: f64 = 0.2;
/// Numbers of an observation.
pub const OBSERVATION_LEN: usize = 6;
/// The pusher stays within this distance of the middle along each axis, m.
const REACH: f64 = 0.3;
/// An episode ends with the centre of the T farther from the middle along an axis, m.
const TABLE: f64 = 0.25;
/// Radius of the pusher, m.
const PUSHER_RADIUS: f64 = 0.015;
/// Success: distance of the centres, m, and angle, rad, of the T and the goal.
pub const TOLERANCE: (f64, f64) = (0.02, 0.15);
