//! Visual odometry.

mod archive;
mod bundle;
mod camera_frame;
mod closing;
mod ground;
mod key_frames;
mod landmark;
mod params;
mod relocalisation;
mod start;
mod tracking;
mod visual_odometry;

pub use camera_frame::{CameraFrame, CameraKind};
pub use closing::LoopReport;
pub use params::OdometryParams;
pub use tracking::{LossReason, Tracking};
pub use visual_odometry::VisualOdometry;
