//! Crops that contain objects (Liu et al., SSD: single shot multibox detector, 2016).

use opendr_engine::dataset::Sample;
use opendr_engine::params::Params;
use opendr_engine::target::BoundingBox;
use opendr_engine::{Random, Result, Value};

use crate::augment::picture::{AffineMap, Border, image_size, transform};
use crate::augment::{Augment, Augmentation, OtherSamples};

/// Smallest IoU of the crop with an object, one of which is drawn; `None` keeps the whole image.
const OVERLAPS: [Option<f32>; 7] = [None, Some(0.0), Some(0.1), Some(0.3), Some(0.5), Some(0.7), Some(0.9)];

/// Crops a window that overlaps an object by a random smallest IoU; boxes whose centre lies outside are dropped.
#[derive(Debug, Clone, Params)]
pub struct IouCrop {
    /// Smallest side of the window, as a share of the image's.
    #[param(default = 0.3, range = 0.01..=1.0)]
    pub min_scale: f32,
    /// Largest side of the window, as a share of the image's.
    #[param(default = 1.0, range = 0.01..=1.0)]
    pub max_scale: f32,
    /// Smallest aspect ratio (width over height) of the window.
    #[param(default = 0.5, range = 0.01..=100.0, log)]
    pub min_ratio: f32,
    /// Largest aspect ratio of the window.
    #[param(default = 2.0, range = 0.01..=100.0, log)]
    pub max_ratio: f32,
    /// Number of windows that are drawn for each smallest IoU.
    #[param(default = 40, range = 1..=1000)]
    pub tries: usize,
}

impl IouCrop {
    /// Draws the window `[left, top, width, height]`; `None` for the whole image.
    fn window(&self, size: [usize; 2], boxes: &[[f32; 4]], random: &mut Random) -> Option<[usize; 4]> {
        // A round ends with the whole image with probability 1/7, so the loop terminates.
        loop {
            let min_iou = OVERLAPS[random.below(OVERLAPS.len())]?;
            for _ in 0..self.tries {
                let sides = size.map(|side| {
                    let share = random.uniform(self.min_scale, self.max_scale);
                    ((side as f32 * share).round() as usize).clamp(1, side)
                });
                let corner = [0, 1].map(|axis| random.below(size[axis] - sides[axis] + 1));
                let ratio = sides[0] as f32 / sides[1] as f32;
                let window = [corner[0], corner[1], sides[0], sides[1]];
                let fits = (self.min_ratio..=self.max_ratio).contains(&ratio)
                    && contains_object(window, boxes, min_iou);
                if fits {
                    return Some(window);
                }
            }
        }
    }
}

/// Returns whether a window contains the centre of a box and overlaps one by at least `min_iou`; true without boxes.
fn contains_object(window: [usize; 4], boxes: &[[f32; 4]], min_iou: f32) -> bool {
    let corners = corners_of(window);
    let overlaps = boxes.iter().any(|object| overlap(corners, *object) >= min_iou);
    boxes.is_empty() || (overlaps && boxes.iter().any(|object| has_centre(corners, *object)))
}

fn corners_of([left, top, width, height]: [usize; 4]) -> [f32; 4] {
    [left, top, left + width, top + height].map(|edge| edge as f32)
}

fn has_centre([x0, y0, x1, y1]: [f32; 4], object: [f32; 4]) -> bool {
    let (x, y) = ((object[0] + object[2]) / 2.0, (object[1] + object[3]) / 2.0);
    x0 < x && x < x1 && y0 < y && y < y1
}

/// Returns the intersection over union.
fn overlap(one: [f32; 4], other: [f32; 4]) -> f32 {
    let area = |[x0, y0, x1, y1]: [f32; 4]| (x1 - x0).max(0.0) * (y1 - y0).max(0.0);
    let both = area([one[0].max(other[0]), one[1].max(other[1]), one[2].min(other[2]), one[3].min(other[3])]);
    both / (area(one) + area(other) - both)
}

impl Augmentation for IouCrop {
    const NAME: &'static str = "iou_crop";
    const ABOUT: &'static str = "crops a window that contains objects, as in SSD";
}

impl Augment for IouCrop {
    fn apply(&self, sample: &mut Sample, random: &mut Random, _: &OtherSamples<'_>) -> Result<()> {
        let size = image_size(sample)?;
        let mut boxes = Vec::new();
        retain_boxes(sample, |object| {
            boxes.push(object.corners());
            true
        });
        let Some(window) = self.window(size, &boxes, random) else { return Ok(()) };
        let corners = corners_of(window);
        retain_boxes(sample, |object| has_centre(corners, object.corners()));
        let [left, top, width, height] = window;
        let map = AffineMap::crop(size, [left as i64, top as i64], [width, height]);
        transform(sample, &map, &Border::default())
    }
}

/// Keeps the boxes of a sample for which `keep` returns true.
fn retain_boxes(sample: &mut Sample, mut keep: impl FnMut(&BoundingBox) -> bool) {
    for value in sample.data.iter_mut().chain(&mut sample.target) {
        match value {
            Value::ImageWithDetections(both) => both.boxes.boxes.retain(&mut keep),
            Value::BoundingBoxList(list) => list.boxes.retain(&mut keep),
            Value::TrackingAnnotationList(list) => list.annotations.retain(|track| keep(&track.bounding_box)),
            _ => {}
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn windows_have_the_smallest_overlap() {
        let boxes = [[10.0, 10.0, 60.0, 90.0], [300.0, 200.0, 420.0, 330.0]];
        let (crop, mut random, mut whole) = (IouCrop::default(), Random::new(5), 0);
        for _ in 0..500 {
            let Some(window) = crop.window([500, 375], &boxes, &mut random) else {
                whole += 1;
                continue;
            };
            let [left, top, width, height] = window;
            assert!(left + width <= 500 && top + height <= 375);
            assert!((0.5..=2.0).contains(&(width as f32 / height as f32)));
            assert!(boxes.iter().any(|object| has_centre(corners_of(window), *object)));
        }
        assert!((50..250).contains(&whole), "{whole}");
        assert_eq!(overlap([0.0, 0.0, 2.0, 1.0], [1.0, 0.0, 3.0, 1.0]), 1.0 / 3.0);
    }
}
