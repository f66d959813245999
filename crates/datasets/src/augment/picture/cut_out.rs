//! Cutout (DeVries and Taylor, Improved regularization with cutout, 2017).

use opendr_engine::dataset::Sample;
use opendr_engine::params::Params;
use opendr_engine::{Random, Result, Value};

use crate::augment::picture::image_size;
use crate::augment::picture::pixels::{Bytes, for_each_u8_image};
use crate::augment::{Augment, Augmentation, OtherSamples};

/// Covers random rectangles of an image with grey, which simulates occlusion. Keypoints and label maps are kept.
#[derive(Debug, Clone, Params)]
pub struct CutOut {
    /// Number of rectangles.
    #[param(default = 1, range = 1..=100)]
    pub count: usize,
    /// Smallest side of a rectangle, as a share of the image's.
    #[param(default = 0.05, range = 0.0..=1.0)]
    pub min_side: f32,
    /// Largest side of a rectangle, as a share of the image's.
    #[param(default = 0.3, range = 0.0..=1.0)]
    pub max_side: f32,
    /// Grey level of the rectangles.
    #[param(default = 114, range = 0..=255)]
    pub level: u32,
    /// Smallest uncovered share of a box; boxes with less after one rectangle are dropped.
    #[param(default = 0.25, range = 0.0..=1.0)]
    pub min_visible: f32,
}

impl Augmentation for CutOut {
    const NAME: &'static str = "cut_out";
    const ABOUT: &'static str = "covers rectangles with grey";
}

impl Augment for CutOut {
    fn apply(&self, sample: &mut Sample, random: &mut Random, _: &OtherSamples<'_>) -> Result<()> {
        let size = image_size(sample)?;
        for _ in 0..self.count {
            let sides = size.map(|side| {
                let share = random.uniform(self.min_side, self.max_side);
                ((side as f32 * share).round() as usize).min(side)
            });
            let [left, top] = [0, 1].map(|axis| random.below(size[axis] - sides[axis] + 1));
            let hole = [left, top, left + sides[0], top + sides[1]];
            for_each_u8_image(sample, |picture| cover(picture, hole, self.level.min(255) as u8))?;
            let hole = hole.map(|edge| edge as f32);
            self.drop_hidden(sample, hole);
        }
        Ok(())
    }
}

impl CutOut {
    fn drop_hidden(&self, sample: &mut Sample, hole: [f32; 4]) {
        let is_visible = |corners: [f32; 4]| 1.0 - covered(corners, hole) >= self.min_visible;
        for value in sample.data.iter_mut().chain(&mut sample.target) {
            match value {
                Value::ImageWithDetections(both) => {
                    both.boxes.boxes.retain(|object| is_visible(object.corners()));
                }
                Value::BoundingBoxList(list) => list.boxes.retain(|object| is_visible(object.corners())),
                Value::TrackingAnnotationList(list) => {
                    list.annotations.retain(|track| is_visible(track.bounding_box.corners()));
                }
                _ => {}
            }
        }
    }
}

/// Returns the share of a box that a rectangle covers.
fn covered([x0, y0, x1, y1]: [f32; 4], hole: [f32; 4]) -> f32 {
    let along = |low: f32, high: f32, from: f32, to: f32| (high.min(to) - low.max(from)).max(0.0);
    let area = (x1 - x0) * (y1 - y0);
    let both = along(x0, x1, hole[0], hole[2]) * along(y0, y1, hole[1], hole[3]);
    if area > 0.0 { both / area } else { 0.0 }
}

fn cover(picture: Bytes<'_>, [left, top, right, bottom]: [usize; 4], level: u8) {
    let Bytes { samples, width, channels } = picture;
    for row in samples.chunks_exact_mut(width * channels).take(bottom).skip(top) {
        row[left * channels..right * channels].fill(level);
    }
}
