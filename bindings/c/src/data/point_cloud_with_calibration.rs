//! Point clouds with the calibration of lidar and camera.

use opendr::data::PointCloudWithCalibration;

use crate::handle::Out;
use crate::pointer::{place, slice};
use crate::status::{guard, opendr_status};
use crate::value::{
    AnyValue, opendr_calibration, opendr_point_cloud, opendr_point_cloud_with_calibration, typed,
};

/// Creates a point cloud with its calibration; the caller keeps both. image_shape is the height and width of the camera's
/// image in pixels, or NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_point_cloud_with_calibration_create(
    cloud: *const opendr_point_cloud,
    calibration: *const opendr_calibration,
    image_shape: *const usize,
    both: *mut *mut opendr_point_cloud_with_calibration,
) -> opendr_status {
    guard(|| {
        let sides = if image_shape.is_null() { 0 } else { 2 };
        // SAFETY: the rules at the top of opendr.h.
        let (out, cloud, calibration, shape) = unsafe {
            (
                Out::new(both, "both")?,
                typed(cloud, "cloud")?,
                typed(calibration, "calibration")?,
                slice(image_shape, sides, "image_shape")?,
            )
        };
        let (cloud, calibration) = (Clone::clone(cloud), Clone::clone(calibration));
        out.set(AnyValue::from(PointCloudWithCalibration::new(cloud, calibration, shape.try_into().ok())));
        Ok(())
    })
}

/// Creates new handles of the point cloud and of the calibration, which must be freed; height and width of the image are 0
/// when unknown.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_point_cloud_with_calibration_read(
    both: *const opendr_point_cloud_with_calibration,
    cloud: *mut *mut opendr_point_cloud,
    calibration: *mut *mut opendr_calibration,
    height: *mut usize,
    width: *mut usize,
) -> opendr_status {
    guard(|| {
        let (height, width) = (place(height, "height")?, place(width, "width")?);
        // SAFETY: the rules at the top of opendr.h.
        let (cloud, calibration) =
            unsafe { (Out::new(cloud, "cloud")?, Out::new(calibration, "calibration")?) };
        // SAFETY: the rules at the top of opendr.h.
        unsafe {
            let both = typed::<PointCloudWithCalibration, _>(both, "both")?;
            let [rows, columns] = both.image_shape.unwrap_or_default();
            height.write(rows);
            width.write(columns);
            cloud.set(AnyValue::from(both.cloud.clone()));
            calibration.set(AnyValue::from(both.calibration.clone()));
        }
        Ok(())
    })
}
