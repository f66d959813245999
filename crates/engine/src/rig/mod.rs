//! Cameras that move: rigs that carry out an [`Action`](crate::target::Action) and take an image.
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
    /// Axes of its actions, in the order azimuth, elevation, distance, roll or zoom; 1 to 4.
    fn axes(&self) -> &[ViewAxis];

    /// Where the camera is.
    fn pose(&self) -> ViewPose;

    /// Moves, and returns the part of the action that was carried out and the limits that stopped the rest.
    ///
    /// # Errors
    /// `InvalidInput` for an action with another number of axes than the rig has, and those of the device.
    fn apply(&mut self, action: &Action) -> Result<Achieved>;

    /// Takes an image from where the camera is.
    ///
    /// # Errors
    /// Those of the camera.
    fn capture(&mut self) -> Result<Image>;
}

/// A boxed rig is one too.
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
