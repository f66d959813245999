//! Activity recognition in videos.
//!
//! [`X3d`] classifies clips; [`CoX3d`] classifies a stream frame by frame with the same weights and equal predictions.

mod co_x3d;
#[cfg(feature = "training")]
mod fit;
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
#[cfg(feature = "training")]
pub use fit::X3dFitParams;
pub use sizes::Backbone;
use sizes::Sizes;
pub use x3d::{X3d, X3dParams};

#[cfg(test)]
#[cfg(feature = "training")]
mod tests;
