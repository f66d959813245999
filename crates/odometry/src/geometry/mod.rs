//! Geometry of cameras: rotations, poses, pinhole projection and the minimal problems of several views.

mod camera;
mod cholesky;
mod eigen;
mod essential;
mod p3p;
mod polynomial;
mod pose;
mod refine;
mod resection;
mod similarity;
mod triangulation;
mod vector;

pub use camera::PinholeCamera;
pub use pose::{Pose, Rotation};
pub use similarity::Similarity3;

pub(crate) use camera::is_image_size;
pub(crate) use cholesky::solve_in_place;
pub(crate) use essential::{TwoViews, relative_pose};
pub(crate) use pose::exponential;
pub(crate) use refine::{Sight, by_pose, moved, projection_slopes};
pub(crate) use resection::{Resection, resect};
pub(crate) use triangulation::triangulate;
pub(crate) use vector::{Vector, distance, length, plus, scaled};

#[cfg(test)]
mod tests;
