//! A camera on a sphere around a subject that can only be recognised from some views: worlds of active perception.
//!
//! Subjects are generated: heads with the identity on the front, everyday objects whose label is on one side, figures whose pose
//! shows from the front. The camera begins anywhere around the subject, far or near, with light from any direction, an
//! occluder in half of the episodes, sensor noise, and motion blur after a movement. All numbers follow from seeds.
//!
//! The subject's frame has x to the front, y to the left, z up; its radius is 1.

mod asset;
mod conditions;
mod environment;
mod figure;
mod head;
mod object;
mod octahedron;
mod picture;
mod subject;
mod surface;
#[cfg(test)]
mod tests;
mod world;

pub use asset::Asset;
pub use conditions::Conditions;
pub(crate) use environment::registrations;
pub use environment::{MOVES, SphereView, SphereViewParams};
pub use subject::{CLASSES, Subject};
pub use world::{SIDE, SphereWorld};
