//! Trajectories: files, alignment and errors.

mod errors;
mod kitti;
#[cfg(test)]
mod tests;
mod trajectory_type;
mod tum;

pub use errors::{Alignment, RelativeErrors, Statistics, absolute_errors, kitti_drift, relative_errors};
pub use errors::{DriftErrors, KITTI_LENGTHS};
pub use trajectory_type::{Stamped, Trajectory};
