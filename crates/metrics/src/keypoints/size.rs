//! Sizes of poses, by which the distances of joints are normalised.

use opendr_engine::target::{BoundingBox, Pose};

use super::params::{KeypointsParams, PoseSize};
use super::places::place_of;

impl KeypointsParams {
    /// Returns the size in pixels; `None` if the pose has no positive size. A pose without a region uses the box around its
    /// joints.
    pub(super) fn size_of_pose(&self, pose: &Pose) -> Option<f64> {
        let size = match self.normalize {
            PoseSize::Box | PoseSize::Area | PoseSize::Head => {
                let [width, height] = match pose.region.as_deref() {
                    Some(BoundingBox { width, height, .. }) => [*width, *height],
                    None => pose.bounding_box().map(|[_, _, width, height]| [width, height])?,
                };
                let (width, height) = (f64::from(width), f64::from(height));
                match self.normalize {
                    PoseSize::Area => (width * height).sqrt(),
                    PoseSize::Head => 0.6 * width.hypot(height),
                    _ => width.max(height),
                }
            }
            PoseSize::Torso => {
                let joint = |name| pose.skeleton.joint(name);
                distance_of_middles(pose, &[joint("l_sho")?], &[joint("r_hip")?])?
            }
            PoseSize::Joints => {
                let (first, second) = self.joints.split_at(self.joints.len() / 2);
                distance_of_middles(pose, first, second)?
            }
        };
        (size > 0.0 && size.is_finite()).then_some(size)
    }

    /// Returns whether a normalised distance is correct: below the threshold as in MMPose's PCK, or at most the threshold as
    /// in MPII's PCKh.
    pub(super) fn is_correct(&self, distance: f64) -> bool {
        match self.normalize {
            PoseSize::Head => distance <= self.threshold,
            _ => distance < self.threshold,
        }
    }
}

fn distance_of_middles(pose: &Pose, first: &[usize], second: &[usize]) -> Option<f64> {
    let middle = |joints: &[usize]| {
        let places = joints.iter().map(|joint| place_of(pose.keypoints.get(*joint)?));
        let places = places.collect::<Option<Vec<_>>>()?;
        let sum = places.iter().fold([0.0; 2], |sum, place| [sum[0] + place[0], sum[1] + place[1]]);
        Some(sum.map(|sum| sum / places.len() as f64))
    };
    let ([x0, y0], [x1, y1]) = (middle(first)?, middle(second)?);
    Some((x1 - x0).hypot(y1 - y0))
}
