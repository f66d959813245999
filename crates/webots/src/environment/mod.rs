//! A robot in Webots as an environment.

mod actuators;
mod options;
mod registration;
mod reward;
mod robot_environment;
mod sensors;

pub use options::{LinkKind, WebotsParams};
pub use registration::{ID, registration};
pub use robot_environment::WebotsEnvironment;
