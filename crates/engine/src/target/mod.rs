//! What learners answer. One file per type.

mod action;
mod bounding_box;
mod classes;
mod keypoint;
mod name;
mod pose;
mod skeleton;

pub use action::{Action, ActionBase};
pub use bounding_box::{BoundingBox, BoundingBoxList};
pub use classes::Classes;
pub use keypoint::Keypoint;
pub use name::Name;
pub use pose::{Pose, PoseList};
pub use skeleton::Skeleton;
