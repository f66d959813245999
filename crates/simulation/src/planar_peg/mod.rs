//! A gripper that grasps a peg, carries it around a post and inserts it into a slot: imitation over long horizons.
//!
//! The demonstration of [`PegTeacher`] has several modes (the peg is passed left or right, and so is the post) and rests of random
//! length, so that a policy that imitates single steps averages what must not be averaged, and rests where the teacher did.

mod bench;
mod environment;
mod options;
mod seen;
mod teacher;
#[cfg(test)]
mod tests;
mod view;

pub use environment::PlanarPeg;
pub use options::PlanarPegParams;
pub use teacher::PegTeacher;

/// Seconds of one step of the environment.
pub const CONTROL_PERIOD: f64 = 0.1;
/// Fastest motions, an action of 1: of the gripper, m/s and rad/s, and of each finger, m/s.
pub const MAX_SPEEDS: [f64; 3] = [0.2, 1.5, 0.05];
/// Numbers of an observation, and of an action.
pub const OBSERVATION_LEN: usize = 10;
/// Numbers of an action.
pub const ACTION_LEN: usize = 4;
/// Half side of the table, m.
const REACH: f64 = 0.3;
/// Height of the mouth of the slot over the middle of the table, m.
const MOUTH: f64 = 0.2;
/// Half length and half width of the peg, m.
const PEG: [f64; 2] = [0.045, 0.012];
/// Radius of the post, m.
const POST_RADIUS: f64 = 0.025;
/// Place of the post, m.
const POST: [f64; 2] = [0.0, 0.02];
/// How far each finger opens, m from the middle.
const OPENING: f64 = 0.03;
/// Success: how deep the tip of the peg is in the slot, m.
pub const DEPTH: f64 = 0.03;
