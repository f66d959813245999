//! Labels of rendered persons: boxes, masks and key points.

use opendr_engine::Result;
use opendr_engine::target::{BoundingBox, Keypoint, Pose as BodyPose, Rle, Segment, Segmentation, Skeleton};

use super::rendered::RenderedScene;
use crate::raycast::{Camera, Vector, dot, minus};

/// Fewest visible pixels of a labelled person.
const MIN_PIXELS: usize = 80;
/// Depth by which a joint lies behind the surface of its own body at most, metres.
const BODY_DEPTH: f32 = 0.25;

/// Returns the pose of person `number` (from 1) with box and mask of its visible pixels; `None` if hardly any is visible.
///
/// The confidence of a key point is 1 where it is visible, 0.5 where it is hidden, and 0 outside the image, which COCO writes as
/// visibility 2, 1 and 0.
pub(super) fn label(
    scene: &RenderedScene,
    camera: &Camera,
    number: u16,
    joints: &[Vector; 17],
) -> Result<Option<BodyPose>> {
    let (width, height) = (camera.width(), camera.height());
    let mask: Vec<bool> = scene.instances.iter().map(|instance| *instance == number).collect();
    let area = mask.iter().filter(|pixel| **pixel).count();
    if area < MIN_PIXELS {
        return Ok(None);
    }
    let [left, top, right, bottom] = bounds(&mask, width);
    let segmentation = Segmentation::Rle(Rle::from_mask(&mask, height as u32, width as u32)?);
    let segment = Segment { segmentation, area: area as f32, iscrowd: false };
    let size = [right - left, bottom - top].map(|pixels| pixels as f32);
    let region = BoundingBox {
        segment: Some(segment.into()),
        ..BoundingBox::new(0_i64, left as f32, top as f32, size[0], size[1], 1.0)
    };
    let keypoints = joints.iter().map(|joint| keypoint(scene, camera, number, *joint)).collect();
    Ok(Some(BodyPose {
        keypoints,
        confidence: 1.0,
        id: None,
        skeleton: Skeleton::Coco17,
        region: Some(region.into()),
    }))
}

fn keypoint(scene: &RenderedScene, camera: &Camera, number: u16, joint: Vector) -> Keypoint {
    let Some([x, y]) = camera.project(&scene.pose, joint) else { return Keypoint::MISSING };
    if x < 0.0 || y < 0.0 || x >= camera.width() as f32 || y >= camera.height() as f32 {
        return Keypoint::MISSING;
    }
    let at = y as usize * camera.width() + x as usize;
    let depth = dot(minus(joint, scene.pose.position), scene.pose.axes[0]);
    let is_visible = scene.instances[at] == number && depth < scene.depth[at] + BODY_DEPTH;
    Keypoint { x, y, confidence: if is_visible { 1.0 } else { 0.5 } }
}

/// Returns the first and the last but one column and row of a mask that is not empty.
fn bounds(mask: &[bool], width: usize) -> [usize; 4] {
    let set = mask.iter().enumerate().filter(|(_, pixel)| **pixel).map(|(at, _)| [at % width, at / width]);
    set.fold([usize::MAX, usize::MAX, 0, 0], |[left, top, right, bottom], [x, y]| {
        [left.min(x), top.min(y), right.max(x + 1), bottom.max(y + 1)]
    })
}
