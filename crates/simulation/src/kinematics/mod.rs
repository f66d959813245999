//! Forward and inverse kinematics of arms described by URDF.
//!
//! [`SerialChain`] is a chain of any joints, [`RollArm`] an arm of seven joints with closed-form inverse kinematics, and
//! [`SERVICE_ARM`] the URDF of the arm of the mobile manipulators in this crate.

mod chain;
mod joint;
mod roll_arm;
#[cfg(test)]
mod tests;
mod transform;
mod urdf;

pub use chain::SerialChain;
pub use joint::Joint;
pub use roll_arm::{JointAngles, RollArm};
pub use transform::Transform;

/// URDF of an arm on a mobile base: lengths and joint ranges are about those of a PR2's right arm. Its tip is the link `wrist`; the
/// origin is on the floor below the middle of the base, x ahead, y left, z up, in metres.
pub const SERVICE_ARM: &str = include_str!("service_arm.urdf");
