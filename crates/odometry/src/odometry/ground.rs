//! Scale of a single camera from its height.

use super::landmark::Landmark;
use crate::geometry::{PinholeCamera, Pose};

/// Returns the height of a level camera above the ground in the units of the map: the most frequent depth below the camera among the points
/// in the lower part of the image. `None` when too few points agree.
pub(super) fn height_above_ground(
    camera: &PinholeCamera,
    pose: &Pose,
    landmarks: &[Landmark],
    heights: &mut Vec<f64>,
) -> Option<f64> {
    const LEAST: usize = 6;
    const SPREAD: f64 = 0.05;
    heights.clear();
    let low = camera.principal_point[1] + 0.08 * camera.size[1] as f64;
    for landmark in landmarks.iter().filter(|landmark| landmark.is_followed) {
        let Some(point) = landmark.point else { continue };
        let [x, y, z] = pose.point_in_frame(point);
        // Beside the road stand what may be mistaken for it.
        if f64::from(landmark.place[1]) > low && y > 0.0 && x.abs() < 3.0 * y && z < 11.0 * y {
            heights.push(y);
        }
    }
    heights.sort_by(f64::total_cmp);
    let mut best = (0, 0);
    let mut begin = 0;
    for end in 0..heights.len() {
        while heights[end] > heights[begin] * (1.0 + 2.0 * SPREAD) {
            begin += 1;
        }
        if end - begin >= best.1 - best.0 {
            best = (begin, end);
        }
    }
    (heights.len() >= LEAST && best.1 - best.0 + 1 >= LEAST).then(|| {
        let near = &heights[best.0..=best.1];
        near[near.len() / 2]
    })
}
