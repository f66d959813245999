//! Streets as a lidar on a car sees them: cars, pedestrians, trucks, walls, poles, trees and hedges on sloping ground, made
//! at random from a seed, with the truth of where the objects are.
//!
//! What comes out is synthetic and says so. Its geometry is KITTI's (A. Geiger et al., "Are we ready for autonomous
//! driving?", CVPR 2012): sensor, height above ground, calibration, sizes of cars, rules of what counts as hidden.

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
