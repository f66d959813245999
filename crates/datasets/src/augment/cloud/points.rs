//! The points of a sample, to change them.

use opendr_engine::data::PointCloud;
use opendr_engine::dataset::Sample;
use opendr_engine::{Error, Result, Value};

/// The cloud that a datum is or has.
pub(super) fn cloud(datum: &Value) -> Option<&PointCloud> {
    match datum {
        Value::PointCloud(cloud) => Some(cloud),
        Value::PointCloudWithCalibration(both) => Some(&both.cloud),
        _ => None,
    }
}

/// The cloud that a datum is or has, to change it.
pub(super) fn cloud_mut(datum: &mut Value) -> Option<&mut PointCloud> {
    match datum {
        Value::PointCloud(cloud) => Some(cloud),
        Value::PointCloudWithCalibration(both) => Some(&mut both.cloud),
        _ => None,
    }
}

/// Lends the numbers of a cloud, point by point, to `change`, which may add and remove whole points.
pub(super) fn change_points(cloud: &mut PointCloud, change: impl FnOnce(&mut Vec<f32>)) -> Result<()> {
    let channels = cloud.channels();
    let header = cloud.header.clone();
    let taken = std::mem::replace(cloud, PointCloud::new(Vec::new(), [0, channels])?);
    let mut data = taken.into_array().into_data();
    change(std::sync::Arc::make_mut(&mut data));
    let points = data.len() / channels;
    *cloud = PointCloud::new(data, [points, channels])?.with_header(header);
    Ok(())
}

/// Refuses samples without a cloud, for `change` on each of their clouds.
pub(super) fn each_cloud(sample: &mut Sample, mut change: impl FnMut(&mut Vec<f32>, usize)) -> Result<()> {
    let mut changed = false;
    for cloud in sample.data.iter_mut().filter_map(cloud_mut) {
        let channels = cloud.channels();
        change_points(cloud, |data| change(data, channels))?;
        changed = true;
    }
    if changed { Ok(()) } else { Err(no_cloud(sample)) }
}

#[cold]
pub(super) fn no_cloud(sample: &Sample) -> Error {
    let types: Vec<_> = sample.data.iter().map(|datum| datum.as_value_ref().value_type().name()).collect();
    Error::invalid_input(format!(
        "the sample has no point cloud but {types:?}; use an augmentation for these"
    ))
}
