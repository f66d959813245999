//! KITTI's benchmarks: 3D boxes in lidar scans and images, of single scenes and of sequences.

use std::path::{Path, PathBuf};

use opendr_engine::data::{PointCloud, PointCloudWithCalibration};
use opendr_engine::{Error, Header, Result, Value, ValueType};

use crate::folder::folders_in;

mod calibration;
mod labels;
mod object;
mod tracking;
mod velodyne;
mod write;

pub use calibration::{calibration_from_kitti, kitti_from_calibration, open_kitti_calibration};
pub use object::Kitti;
pub use tracking::KittiTracking;
pub use velodyne::{open_velodyne, velodyne_from_cloud};

/// Names of the parts; the one with labels comes first.
const PARTS: [&str; 2] = ["training", "testing"];

/// The files of one frame.
#[derive(Debug, Clone, Default)]
struct Scene {
    picture: Option<PathBuf>,
    cloud: Option<PathBuf>,
    calibration: Option<PathBuf>,
}

impl Scene {
    /// Reads the data that belong to `target`: the cloud for 3D boxes (with its calibration, if there is one), the
    /// image for boxes in the image; the other if only that exists.
    fn data(&self, target: ValueType, header: &Header) -> Result<Vec<Value>> {
        Ok(match (&self.cloud, &self.picture) {
            (Some(cloud), picture) if !is_flat(target) || picture.is_none() => {
                let cloud = open_velodyne(cloud)?.with_header(header.clone());
                vec![self.with_calibration(cloud)?]
            }
            (_, Some(picture)) => {
                vec![Value::Image(opendr_vision::open(picture)?.with_header(header.clone()))]
            }
            (_, None) => Vec::new(),
        })
    }

    /// Returns the file of the datum that belongs to `target`.
    fn path(&self, target: ValueType) -> Option<PathBuf> {
        match is_flat(target) {
            true => self.picture.clone().or_else(|| self.cloud.clone()),
            false => self.cloud.clone().or_else(|| self.picture.clone()),
        }
    }

    fn with_calibration(&self, cloud: PointCloud) -> Result<Value> {
        let Some(path) = &self.calibration else { return Ok(Value::PointCloud(cloud)) };
        let calibration = open_kitti_calibration(path)?;
        let image_shape = self.picture.as_deref().and_then(png_shape);
        Ok(Value::PointCloudWithCalibration(PointCloudWithCalibration::new(cloud, calibration, image_shape)))
    }
}

/// Returns whether the target lies in the image.
fn is_flat(target: ValueType) -> bool {
    matches!(target, ValueType::BoundingBoxList | ValueType::TrackingAnnotationList)
}

/// Reads `[height, width]` of a PNG image from its first bytes.
fn png_shape(path: &Path) -> Option<[usize; 2]> {
    use std::io::Read;
    let mut head = [0; 24];
    std::fs::File::open(path).ok()?.read_exact(&mut head).ok()?;
    head.starts_with(b"\x89PNG\r\n\x1a\n").then_some(())?;
    let side = |at: usize| Some(u32::from_be_bytes(*head.get(at..)?.first_chunk()?) as usize);
    Some([side(20)?, side(16)?])
}

/// Returns the folder that contains `folders`: `path` itself or its part.
fn folder_with(path: &Path, wanted: Option<&str>, folders: &[&str]) -> Result<Option<PathBuf>> {
    let has = |folder: &Path| folders.iter().any(|name| folder.join(name).is_dir());
    let wanted = match wanted {
        Some("train" | "val" | "trainval") => Some("training"),
        Some("test") => Some("testing"),
        other => other,
    };
    match wanted {
        _ if has(path) => Ok(Some(path.to_owned())),
        Some(part) if PARTS.contains(&part) && !path.join(part).is_dir() => {
            let there = folders_in(path).join(", ");
            Err(Error::not_found(format!("no part {part} in {}; there are {there}", path.display())))
        }
        Some(part) if PARTS.contains(&part) => Ok(Some(path.join(part)).filter(|folder| has(folder))),
        Some(part) => Err(Error::not_found(format!(
            "KITTI has the parts training, testing, train and val, not {part:.40?}"
        ))),
        None => Ok(PARTS.iter().map(|part| path.join(part)).find(|folder| has(folder))),
    }
}

/// Runs every parser of lines, for the fuzzers.
pub(crate) fn parse_any(text: &str) {
    for line in text.lines() {
        let _ = labels::object_from_line(line);
        let _ = labels::track_from_line(line);
    }
}

#[cfg(test)]
mod tests;
