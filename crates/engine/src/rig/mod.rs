//! Cameras that move: rigs that carry out an [`Action`] and capture an image.
//!
//! A rig moves on a sphere around its subject. An action is relative: each of its 1 to 4 numbers is a share, in [-1, 1],
//! of the step that the rig states for that axis.

mod achieved;
mod axis;
mod sphere;
#[cfg(test)]
mod tests;
mod view_pose;

use crate::Result;
use crate::data::Image;
use crate::target::Action;

pub use achieved::{Achieved, Limit};
pub use axis::ViewAxis;
pub use sphere::ViewSphere;
pub use view_pose::ViewPose;

/// A camera that carries out actions: on a gimbal, a drone or an arm, in a simulator, or over recorded views.
pub trait ViewRig {
    /// Returns the axes of its actions, in the order azimuth, elevation, distance, roll or zoom; 1 to 4.
    fn axes(&self) -> &[ViewAxis];

    /// Returns the pose of the camera.
    fn pose(&self) -> ViewPose;

    /// Moves, and returns the part of the action that was carried out and the limits that stopped the rest.
    ///
    /// # Errors
    /// Returns `InvalidInput` for an action with another number of axes, and errors of the device.
    fn apply(&mut self, action: &Action) -> Result<Achieved>;

    /// Captures an image at the current pose.
    ///
    /// # Errors
    /// Returns errors of the camera.
    fn capture(&mut self) -> Result<Image>;
}

/// Boxed rigs are rigs.
impl<R: ViewRig + ?Sized> ViewRig for Box<R> {
    fn axes(&self) -> &[ViewAxis] {
        (**self).axes()
    }

    fn pose(&self) -> ViewPose {
        (**self).pose()
    }

    fn apply(&mut self, action: &Action) -> Result<Achieved> {
        (**self).apply(action)
    }

    fn capture(&mut self) -> Result<Image> {
        (**self).capture()
    }
}
