//! Access to the points of a sample.

use opendr_engine::data::PointCloud;
use opendr_engine::dataset::Sample;
use opendr_engine::{Error, Result, Value};

/// Returns the cloud of a datum.
pub(super) fn cloud(datum: &Value) -> Option<&PointCloud> {
    match datum {
        Value::PointCloud(cloud) => Some(cloud),
        Value::PointCloudWithCalibration(both) => Some(&both.cloud),
        _ => None,
    }
}

/// Returns the cloud of a datum, mutable.
pub(super) fn cloud_mut(datum: &mut Value) -> Option<&mut PointCloud> {
    match datum {
        Value::PointCloud(cloud) => Some(cloud),
        Value::PointCloudWithCalibration(both) => Some(&mut both.cloud),
        _ => None,
    }
}

/// Passes the values of a cloud, point by point, to `change`, which may add and remove whole points.
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

/// Calls `change` with the values and the channels of each cloud; a sample without a cloud is an error.
pub(super) fn for_each_cloud(
    sample: &mut Sample,
    mut change: impl FnMut(&mut Vec<f32>, usize),
) -> Result<()> {
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
        "the sample has {types:?} instead of a point cloud; use an augmentation for these types"
    ))
}
