//! Input of the learner: points, with or without the calibration of a camera.

use std::sync::LazyLock;

use opendr_engine::data::{Calibration, PointCloud, PointCloudWithCalibration};
use opendr_engine::learner::{Inputs, Port, Ports};
use opendr_engine::{Header, Result, ValueRef, ValueType};

/// A scan of a lidar.
#[derive(Debug, Clone, Copy)]
pub enum Scan<'a> {
    /// Points alone, as if lidar and camera were in the same place ([`Calibration::nominal`]).
    Cloud(&'a PointCloud),
    /// Points with the calibration of a camera. Where the image size is known, only boxes in the image are returned.
    Calibrated(&'a PointCloudWithCalibration),
}

/// Name of the port.
const PORT: &str = "point_cloud";

static NOMINAL: LazyLock<Calibration> = LazyLock::new(Calibration::nominal);

impl<'a> Scan<'a> {
    /// Returns the points.
    pub fn cloud(&self) -> &'a PointCloud {
        match self {
            Self::Cloud(cloud) => cloud,
            Self::Calibrated(scan) => &scan.cloud,
        }
    }

    /// Returns the calibration between lidar and camera.
    pub fn calibration(&self) -> &'a Calibration {
        match self {
            Self::Cloud(_) => &NOMINAL,
            Self::Calibrated(scan) => &scan.calibration,
        }
    }

    /// Returns height and width of the camera's image.
    pub fn image_shape(&self) -> Option<[usize; 2]> {
        match self {
            Self::Cloud(_) => None,
            Self::Calibrated(scan) => scan.image_shape,
        }
    }
}

impl<'a> Inputs<'a> for Scan<'a> {
    const PORTS: &'static [Port] = &[Port {
        name: PORT,
        doc: "Scan of a lidar; with a PointCloudWithCalibration, the boxes are in its camera's frame and image.",
        value_type: ValueType::PointCloud,
        optional: false,
        init: false,
    }];

    fn from_ports(ports: &Ports<'a>) -> Result<Self> {
        match ports.get(PORT) {
            Some(ValueRef::PointCloudWithCalibration(scan)) => Ok(Self::Calibrated(scan)),
            _ => ports.required(PORT).map(Self::Cloud),
        }
    }

    fn header(&self) -> &Header {
        match self {
            Self::Cloud(cloud) => &cloud.header,
            Self::Calibrated(scan) => &scan.header,
        }
    }
}

impl<'a> From<&'a PointCloud> for Scan<'a> {
    fn from(cloud: &'a PointCloud) -> Self {
        Self::Cloud(cloud)
    }
}

impl<'a> From<&'a PointCloudWithCalibration> for Scan<'a> {
    fn from(scan: &'a PointCloudWithCalibration) -> Self {
        Self::Calibrated(scan)
    }
}
