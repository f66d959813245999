//! Trajectories: files, alignment and errors.

mod errors;
mod kitti;
mod trajectory_type;
mod tum;
#[cfg(test)]
mod tests;

pub use errors::{Alignment, RelativeErrors, Statistics, absolute_errors, kitti_drift, relative_errors};
pub use errors::{DriftErrors, KITTI_LENGTHS};
pub use trajectory_type::{Stamped, Trajectory};
