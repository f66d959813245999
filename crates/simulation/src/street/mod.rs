//! Random street scenes for a lidar on a car: cars, pedestrians, trucks, walls, poles, trees and hedges on inclined ground, with
//! the ground truth of the objects.
//!
//! The data is synthetic. Its geometry is KITTI's (A. Geiger et al., "Are we ready for autonomous
//! driving?", CVPR 2012): sensor, height above ground, calibration, sizes of cars, levels of occlusion.

mod car_body;
mod drives;
mod layout;
mod motion;
mod scans;
mod segments;
#[cfg(test)]
mod tests;

pub use car_body::CarShape;
pub use drives::StreetDrives;
pub use layout::{Street, StreetKind, StreetObject};
pub use scans::StreetScans;
pub use segments::StreetSegments;
