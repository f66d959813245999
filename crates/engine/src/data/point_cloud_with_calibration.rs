//! Points in space beside a camera.

use std::fmt;

use crate::Header;
use crate::data::{Calibration, Data, PointCloud};

/// A cloud with the calibration between lidar and camera.
#[derive(Debug, Clone, PartialEq)]
pub struct PointCloudWithCalibration {
    /// When and where it was taken; that of the cloud does not count.
    pub header: Header,
    /// The points.
    pub cloud: PointCloud,
    /// Between lidar and camera (OpenDR's `calib`).
    pub calibration: Calibration,
    /// `[height, width]` of the camera's picture, pixels.
    pub image_shape: Option<[usize; 2]>,
}

impl PointCloudWithCalibration {
    /// The cloud with its calibration; the header is the cloud's.
    pub fn new(cloud: PointCloud, calibration: Calibration, image_shape: Option<[usize; 2]>) -> Self {
        Self { header: cloud.header.clone(), cloud, calibration, image_shape }
    }
}

impl Data for PointCloudWithCalibration {}

/// OpenDR's text; `{:#}` gives type and shape.
impl fmt::Display for PointCloudWithCalibration {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if f.alternate() {
            return crate::data::write_shape("PointCloudWithCalibration", &self.cloud.shape(), f);
        }
        write!(f, "{}\nCalib:{}", self.cloud, self.calibration)
    }
}
