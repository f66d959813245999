//! Grasps from above with a parallel gripper: a camera over a table, five objects, and physics that closes the fingers.
//!
//! The camera images are rendered analytically: objects are extruded polygons, depth is exact up to its noise. An attempt is place,
//! angle and width of a grasp; the fingers come down beside the object, close with limited force, and the object is held if friction
//! carries its weight and keeps it in the grip while the gripper moves. [`GraspDemonstration`] is the view and the grasp that a person
//! would show, for learners from a single demonstration.

mod attempt;
mod camera;
mod demonstration;
mod environment;
mod grasp;
mod object;
mod options;
mod scene;
#[cfg(test)]
mod tests;

pub use attempt::Outcome;
pub use camera::Camera;
pub use demonstration::GraspDemonstration;
pub use environment::PlanarGrasp;
pub use grasp::Grasp;
pub use object::GraspObject;
pub use options::PlanarGraspParams;

/// Half side of the part of the table that the camera sees, m.
pub const HALF_VIEW: f64 = 0.15;
/// Height of the objects, at which a grasp is seen in an image, m.
pub const GRASP_HEIGHT: f64 = 0.025;
/// Widest opening of the gripper, m.
pub const MAX_WIDTH: f64 = 0.09;
/// Attempts of an episode.
pub const ATTEMPTS: u32 = 20;
