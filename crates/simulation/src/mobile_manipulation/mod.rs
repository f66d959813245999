//! Mobile manipulation as kinematic feasibility: the gripper follows a planned motion, a policy moves the base so that the arm
//! can follow.
//!
//! Task, observations, rewards and protocol are those of OpenDR's `MobileRLLearner` (Honerkamp, Welschehold and Valada, Learning
//! kinematic feasibility for mobile manipulation through deep reinforcement learning, 2021) in its analytical world, without
//! MoveIt and ROS. The arm is [`SERVICE_ARM`](crate::kinematics::SERVICE_ARM). The motions that open doors and drawers are arcs and
//! lines; OpenDR's are learnt from demonstrations. Metres, seconds, radians; z up.

mod base;
mod controllers;
mod environment;
mod episode;
mod motion;
mod options;
mod task;
#[cfg(test)]
mod tests;
mod variants;
mod view;

pub use controllers::{BaseFollows, BaseStill, ReachKeeper};
pub use environment::MobileManipulation;
pub use options::{BaseKind, MobileManipulationParams, Strategy};
pub use task::Task;
pub(crate) use variants::registrations;
pub use variants::{
    DiffDoor, DiffDrawer, DiffPickPlace, DiffReach, OmniDoor, OmniDrawer, OmniPickPlace, OmniReach,
};

/// Seconds of one step.
pub const CONTROL_PERIOD: f64 = 0.1;
/// Numbers of an observation: gripper (7), planned motion of the gripper (7) and goal (7) in the frame of the base, joints (7).
pub const OBSERVATION_LEN: usize = 28;
/// Largest speed of the base in m/s, and in rad/s.
pub const BASE_SPEED: f64 = 0.2;
/// Largest turn rate of the base, rad/s.
pub const TURN_RATE: f64 = 1.0;
/// Slowest and fastest planned speed of the gripper, m/s.
const GRIPPER_SPEEDS: [f64; 2] = [0.001, 0.1];
/// Distance in metres and in radians at which the gripper has reached a goal.
const TOLERANCES: [f64; 2] = [0.025, 0.05];
/// Steps after which an episode is truncated.
const LIMIT: u32 = 5000;
