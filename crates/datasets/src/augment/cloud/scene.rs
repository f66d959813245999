//! Transformation of a whole scene about the lidar.

use std::f32::consts::{PI, TAU};

use opendr_engine::data::PointCloudWithCalibration;
use opendr_engine::dataset::Sample;
use opendr_engine::target::BoundingBox3D;
use opendr_engine::{Error, Result, Value};

use crate::augment::cloud::boxes::corners;
use crate::augment::cloud::frame::Frame;
use crate::augment::cloud::points::{change_points, cloud, cloud_mut, no_cloud};

/// A transformation of the scene about the lidar, in the camera frame: first mirrored, then rotated, then scaled.
///
/// Boxes are defined in the camera frame, whose vertical axis differs slightly from the lidar's. The points are
/// therefore changed in that frame too, which keeps every point exactly in its box.
#[derive(Debug, Clone, Copy)]
pub(super) struct SceneChange {
    /// Whether left and right are swapped.
    pub(super) mirrored: bool,
    /// Angle about the vertical axis in radians, with the sign of `rotation_y`.
    pub(super) angle: f64,
    pub(super) scale: f64,
}

impl SceneChange {
    pub(super) const NONE: Self = Self { mirrored: false, angle: 0.0, scale: 1.0 };

    /// Transforms the clouds of `sample` and the boxes of its target.
    pub(super) fn apply(&self, sample: &mut Sample) -> Result<()> {
        let Some(first) = sample.data.iter().find(|datum| cloud(datum).is_some()) else {
            return Err(no_cloud(sample));
        };
        let frame = Frame::of(first)?;
        let calibrated = match first {
            Value::PointCloudWithCalibration(both) => Some(both.clone()),
            _ => None,
        };
        for datum in &mut sample.data {
            let frame = Frame::of(datum)?;
            let Some(cloud) = cloud_mut(datum) else {
                return Err(Error::unsupported(format!(
                    "a {} cannot be transformed together with the point cloud; remove the augmentation",
                    datum.as_value_ref().value_type().name()
                )));
            };
            let channels = cloud.channels();
            change_points(cloud, |data| {
                for point in data.chunks_exact_mut(channels) {
                    let place = frame.camera_from_lidar([point[0], point[1], point[2]].map(f64::from));
                    let place = frame.lidar_from_camera(self.moved(&frame, place));
                    point[..3].copy_from_slice(&place.map(|part| part as f32));
                }
            })?;
        }
        let change = |object: &mut BoundingBox3D| self.move_box(object, &frame, calibrated.as_ref());
        match &mut sample.target {
            None | Some(Value::Category(_)) => Ok(()),
            Some(Value::BoundingBox3DList(list)) => {
                list.boxes.iter_mut().for_each(change);
                Ok(())
            }
            Some(Value::TrackingAnnotation3DList(list)) => {
                list.annotations.iter_mut().map(|track| &mut track.bounding_box_3d).for_each(change);
                Ok(())
            }
            Some(other) => Err(Error::unsupported(format!(
                "a {} cannot be transformed together with the point cloud; remove the augmentation",
                other.as_value_ref().value_type().name()
            ))),
        }
    }

    /// Returns the new location of a point of the camera frame.
    fn moved(&self, frame: &Frame, place: [f64; 3]) -> [f64; 3] {
        let lidar = frame.lidar();
        let [x, y, z] = [0, 1, 2].map(|axis| place[axis] - lidar[axis]);
        let x = if self.mirrored { -x } else { x };
        let (sine, cosine) = self.angle.sin_cos();
        let turned = [cosine * x + sine * z, y, cosine * z - sine * x];
        [0, 1, 2].map(|axis| self.scale * turned[axis] + lidar[axis])
    }

    fn move_box(&self, object: &mut BoundingBox3D, frame: &Frame, scan: Option<&PointCloudWithCalibration>) {
        object.location = self.moved(frame, object.location.map(f64::from)).map(|part| part as f32);
        object.dimensions = object.dimensions.map(|side| (f64::from(side) * self.scale) as f32);
        let turn = if self.mirrored { PI - object.rotation_y } else { object.rotation_y };
        object.rotation_y = within_pi(turn + self.angle as f32);
        object.alpha = within_pi(object.rotation_y - object.location[0].atan2(object.location[2]));
        object.bbox2d = scan.and_then(|scan| box_in_image(object, scan)).unwrap_or_default();
    }
}

fn within_pi(angle: f32) -> f32 {
    (angle + PI).rem_euclid(TAU) - PI
}

/// Returns the box in the image of the camera, `[x0, y0, x1, y1]` in pixels, clipped at its border; `None` if a
/// corner is behind the camera.
fn box_in_image(object: &BoundingBox3D, scan: &PointCloudWithCalibration) -> Option<[f32; 4]> {
    let [height, width] = scan.image_shape.map_or([f32::MAX; 2], |shape| shape.map(|side| side as f32));
    let mut around = [f32::MAX, f32::MAX, f32::MIN, f32::MIN];
    for corner in corners(object) {
        let [x, y] = scan.calibration.image_from_camera(corner)?.map(|part| part as f32);
        around = [around[0].min(x), around[1].min(y), around[2].max(x), around[3].max(y)];
    }
    let [x0, y0, x1, y1] = around;
    Some([x0.clamp(0.0, width), y0.clamp(0.0, height), x1.clamp(0.0, width), y1.clamp(0.0, height)])
}
