//! Augmentations of point clouds and their boxes.

mod boxes;
mod drop_points;
mod flip;
mod frame;
mod jitter_points;
mod paste_objects;
mod points;
mod rotate;
mod scale;
mod scene;

#[cfg(test)]
mod tests;

pub(crate) use boxes::corners;
pub use drop_points::DropPoints;
pub use flip::CloudFlip;
pub(crate) use frame::Frame;
pub use jitter_points::JitterPoints;
pub use paste_objects::PasteObjects;
pub use rotate::CloudRotate;
pub use scale::CloudScale;
