//! What persons do in a video.
//!
//! [`X3d`] looks at clips, [`CoX3d`] at one picture after the other, with the same weights and the same answers.

mod co_x3d;
#[cfg(feature = "training")]
mod network;
#[cfg(feature = "training")]
mod objective;
mod sizes;
#[cfg(feature = "training")]
mod time;
mod x3d;

pub use co_x3d::{CoX3d, CoX3dParams, CoX3dState};
#[cfg(feature = "training")]
pub use co_x3d::{CoX3dFitParams, co_x3d_from};
pub use sizes::Backbone;
use sizes::Sizes;
#[cfg(feature = "training")]
pub use x3d::X3dFitParams;
pub use x3d::{X3d, X3dParams};

#[cfg(test)]
#[cfg(feature = "training")]
mod tests;
