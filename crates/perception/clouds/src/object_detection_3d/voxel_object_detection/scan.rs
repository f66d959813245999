//! What the learner takes: points, with or without the calibration of a camera.

use std::sync::LazyLock;

use opendr_engine::data::{Calibration, PointCloud, PointCloudWithCalibration};
use opendr_engine::learner::{Inputs, Port, Ports};
use opendr_engine::{Header, Result, ValueRef, ValueType};

/// A scan of a lidar.
#[derive(Debug, Clone, Copy)]
pub enum Scan<'a> {
    /// Points alone: lidar and camera are then taken to be in one place ([`Calibration::nominal`]).
    Cloud(&'a PointCloud),
    /// With the calibration of a camera; only what that camera sees is told, where the size of its picture is known.
    Calibrated(&'a PointCloudWithCalibration),
}

/// The name of the port.
const PORT: &str = "point_cloud";

static NOMINAL: LazyLock<Calibration> = LazyLock::new(Calibration::nominal);

impl<'a> Scan<'a> {
    /// The points.
    pub fn cloud(&self) -> &'a PointCloud {
        match self {
            Self::Cloud(cloud) => cloud,
            Self::Calibrated(scan) => &scan.cloud,
        }
    }

    /// How the camera stands to the lidar.
    pub fn calibration(&self) -> &'a Calibration {
        match self {
            Self::Cloud(_) => &NOMINAL,
            Self::Calibrated(scan) => &scan.calibration,
        }
    }

    /// Height and width of the camera's picture.
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
        doc: "What the lidar saw; a PointCloudWithCalibration places the boxes in its camera's frame and picture.",
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
