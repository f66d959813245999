//! Overlap of detections and objects.

use opendr_engine::target::Rle;
use opendr_engine::{Error, Result};

/// Returns the intersection over union of boxes `[left, top, width, height]`; for a crowd the intersection over the area
/// of the detection.
pub fn box_iou(detection: [f64; 4], ground_truth: [f64; 4], crowd: bool) -> f64 {
    let [left, top, wide, high] = detection;
    let [x, y, width, height] = ground_truth;
    let across = (left + wide).min(x + width) - left.max(x);
    let down = (top + high).min(y + height) - top.max(y);
    if !(across > 0.0 && down > 0.0) {
        return 0.0;
    }
    let (both, area) = (across * down, wide * high);
    both / if crowd { area } else { area + width * height - both }
}

/// A mask with its area and extent.
#[derive(Debug, Clone, PartialEq)]
pub struct Mask {
    rle: Rle,
    area: u64,
    extent: [u32; 4],
}

impl Mask {
    /// Returns the number of pixels of the object.
    pub fn area(&self) -> u64 {
        self.area
    }

    /// Returns the intersection over union; for a crowd the intersection over the area of the detection.
    ///
    /// # Errors
    /// Returns `InvalidInput` for masks of different sizes.
    pub fn iou(&self, ground_truth: &Self, crowd: bool) -> Result<f64> {
        let [(left, right), (top, bottom)] = [0, 1].map(|axis| {
            let end = |mask: &Self| mask.extent[axis] + mask.extent[axis + 2];
            (self.extent[axis].max(ground_truth.extent[axis]), end(self).min(end(ground_truth)))
        });
        if self.rle.size() == ground_truth.rle.size() && (left >= right || top >= bottom) {
            return Ok(0.0);
        }
        let both = self.rle.intersection(&ground_truth.rle)?;
        let all = if crowd { self.area } else { self.area + ground_truth.area - both };
        Ok(if both == 0 { 0.0 } else { both as f64 / all as f64 })
    }
}

impl From<Rle> for Mask {
    fn from(rle: Rle) -> Self {
        Self { area: rle.area(), extent: rle.bounding_box(), rle }
    }
}

/// Number of joints of a person in COCO.
pub const JOINTS: usize = 17;

/// Standard deviation of the annotated position of each joint, relative to the square root of the person's area (COCO's
/// published numbers, halved).
const SIGMAS: [f64; JOINTS] = [
    0.026, 0.025, 0.025, 0.035, 0.035, 0.079, 0.079, 0.072, 0.072, 0.062, 0.062, 0.107, 0.107, 0.087, 0.087,
    0.089, 0.089,
];

/// A person with annotated joints.
#[derive(Debug, Clone, PartialEq)]
pub struct Person {
    /// Joints `[x, y, v]` in pixels; `v` is 0 for joints that are not annotated.
    pub joints: [[f64; 3]; JOINTS],
    /// Bounding box `[left, top, width, height]` in pixels.
    pub bounding_box: [f64; 4],
    /// Area in square pixels.
    pub area: f64,
}

/// Returns the object keypoint similarity: the mean over annotated joints of `exp(-d^2 / (2 s^2 k^2))`.
///
/// Without annotated joints, the distance is that to the person's box, doubled.
pub fn keypoint_similarity(detection: &[[f64; 2]; JOINTS], ground_truth: &Person) -> f64 {
    let annotated = ground_truth.joints.iter().filter(|[_, _, visible]| *visible > 0.0).count();
    let [left, top, width, height] = ground_truth.bounding_box;
    let beside = |at: f64, start: f64, length: f64| {
        (start - length - at).max(0.0) + (at - (start + length * 2.0)).max(0.0)
    };
    let joints = detection.iter().zip(&ground_truth.joints).zip(SIGMAS);
    let similarities =
        joints.filter(|((_, joint), _)| annotated == 0 || joint[2] > 0.0).map(|(([x, y], joint), sigma)| {
            let [dx, dy] = match annotated {
                0 => [beside(*x, left, width), beside(*y, top, height)],
                _ => [x - joint[0], y - joint[1]],
            };
            let variance = (sigma * 2.0) * (sigma * 2.0);
            (-((dx * dx + dy * dy) / variance / (ground_truth.area + f64::EPSILON) / 2.0)).exp()
        });
    similarities.sum::<f64>() / if annotated == 0 { JOINTS } else { annotated } as f64
}

/// Checks that a box is finite and its size not negative.
pub(super) fn check_box(bounds: [f64; 4], what: &str) -> Result<()> {
    match bounds.iter().all(|number| number.is_finite()) && bounds[2] >= 0.0 && bounds[3] >= 0.0 {
        true => Ok(()),
        false => Err(Error::invalid_input(format!(
            "a {what} has the box {bounds:?}; left, top, width and height must be finite, and sizes not negative"
        ))),
    }
}
