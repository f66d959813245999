//! A robot in Webots as an environment.

mod actuators;
mod options;
mod registration;
mod reward;
mod robot_environment;
mod sensors;

pub use options::{ID, LinkKind, WebotsParams};
pub use registration::registration;
pub use robot_environment::WebotsEnvironment;
