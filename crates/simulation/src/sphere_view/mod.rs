//! A camera on a sphere around a subject that can only be recognised from some views: worlds of active perception.
//!
//! Subjects are generated: heads with the identity on the front, everyday objects whose label is on one side, figures whose pose
//! is visible from the front. A subject stands in an enclosure that is open towards its front, as a product in a compartment of
//! a shelf, and its front faces any azimuth and an elevation of up to 49 degrees up or down. The camera begins anywhere around
//! the subject, far or near, with light from any direction, a pole as further occluder in half of the episodes, sensor noise,
//! and motion blur after a movement. All numbers follow from seeds.
//!
//! The subject's frame has x to the front, y to the left, z up; its radius is 1.

mod asset;
mod camera_image;
mod conditions;
mod enclosure;
mod environment;
mod figure;
mod generation;
mod head;
mod object;
mod octahedron;
mod subject;
mod surface;
#[cfg(test)]
mod tests;
mod views;
mod world;

pub use asset::Asset;
pub use camera_image::OCCLUDER;
pub use conditions::Conditions;
pub(crate) use environment::registrations;
pub use environment::{MOVES, SphereView, SphereViewParams};
pub use subject::Subject;
pub use surface::TexturedMesh;
pub use views::SubjectViews;
pub use world::{SIDE, SphereWorld};
