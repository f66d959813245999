//! Point clouds with the calibration to a camera.

use std::fmt;

use crate::Header;
use crate::data::{Calibration, Data, PointCloud};

/// A point cloud with the calibration between lidar and camera.
#[derive(Debug, Clone, PartialEq)]
pub struct PointCloudWithCalibration {
    /// Time stamp and coordinate frame; the header of the cloud is ignored.
    pub header: Header,
    /// The points.
    pub cloud: PointCloud,
    /// Calibration between lidar and camera (OpenDR's `calib`).
    pub calibration: Calibration,
    /// `[height, width]` of the camera's image, in pixels.
    pub image_shape: Option<[usize; 2]>,
}

impl PointCloudWithCalibration {
    /// Creates the datum; its header is that of the cloud.
    pub fn new(cloud: PointCloud, calibration: Calibration, image_shape: Option<[usize; 2]>) -> Self {
        Self { header: cloud.header.clone(), cloud, calibration, image_shape }
    }
}

impl Data for PointCloudWithCalibration {}

/// Writes OpenDR's text; with `{:#}`, type and shape.
impl fmt::Display for PointCloudWithCalibration {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if f.alternate() {
            return crate::data::write_shape("PointCloudWithCalibration", &self.cloud.shape(), f);
        }
        write!(f, "{}\nCalib:{}", self.cloud, self.calibration)
    }
}
