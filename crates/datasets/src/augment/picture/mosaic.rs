//! Mosaic of four images (Bochkovskiy et al., YOLOv4, 2020).

use opendr_engine::data::{Image, PixelFormat};
use opendr_engine::dataset::Sample;
use opendr_engine::params::Params;
use opendr_engine::target::Heatmap;
use opendr_engine::{Error, Random, Result, Value};

use crate::augment::picture::border::Border;
use crate::augment::picture::targets::follow;
use crate::augment::picture::warp::check_size;
use crate::augment::picture::{AffineMap, image_size, transform};
use crate::augment::{Augment, Augmentation, OtherSamples};

/// Combines an image with three others around a random point; each is cropped to its quadrant.
#[derive(Debug, Clone, Params)]
pub struct Mosaic {
    /// Width of the result.
    #[param(default = 640, range = 4..=65535, unit = "px")]
    pub width: usize,
    /// Height of the result.
    #[param(default = 640, range = 4..=65535, unit = "px")]
    pub height: usize,
    /// Smallest distance of the point from the border, as a share of the side.
    #[param(default = 0.25, range = 0.05..=0.5)]
    pub margin: f32,
    /// Largest zoom of an image relative to the size that covers its quadrant.
    #[param(default = 1.5, range = 1.0..=10.0)]
    pub max_zoom: f32,
    /// Smallest share of a box inside its quadrant; boxes with less are dropped.
    #[param(default = 0.1, range = 0.0..=1.0)]
    pub min_visible: f32,
}

impl Augmentation for Mosaic {
    const NAME: &'static str = "mosaic";
    const ABOUT: &'static str = "combines four images into one";
}

impl Augment for Mosaic {
    fn apply(&self, sample: &mut Sample, random: &mut Random, others: &OtherSamples<'_>) -> Result<()> {
        let size = [self.width, self.height];
        check_size(size, 3)?;
        let point = size.map(|side| {
            let share = random.uniform(self.margin, 1.0 - self.margin);
            ((side as f32 * share) as usize).min(side - 1).max(1)
        });
        let mut canvas = vec![0u8; self.width * self.height * 3];
        let mut whole: Option<Sample> = None;
        // The quadrant of the sample itself is random, too.
        let own = random.below(4);
        for quarter in 0..4 {
            let mut part = if quarter == own { sample.clone() } else { others.pick(random)? };
            let right_below = [quarter % 2, quarter / 2];
            let corner = [0, 1].map(|axis| right_below[axis] * point[axis]);
            let sides = [0, 1]
                .map(|axis| if right_below[axis] == 0 { point[axis] } else { size[axis] - point[axis] });
            self.fit(&mut part, sides, right_below, random)?;
            paste_picture(&mut canvas, self.width, &part, corner)?;
            let shift = AffineMap::crop(sides, corner.map(|edge| -(edge as i64)), size);
            if let Some(target) = &mut part.target {
                follow(target, &shift, &Border::default())?;
            }
            whole = Some(match whole {
                None => part,
                Some(before) => joined(before, part, [corner[0], corner[1], sides[0], sides[1]])?,
            });
        }
        let header = sample.data.first().map(|datum| datum.header().clone()).unwrap_or_default();
        let image = Image::from_rgb8(canvas, self.width, self.height)?.with_header(header);
        let target = whole.and_then(|whole| whole.target);
        *sample = Sample { data: vec![image.into()], target };
        Ok(())
    }
}

impl Mosaic {
    /// Scales a part to cover `sides` and crops it; its inner corner stays at the point.
    fn fit(
        &self,
        part: &mut Sample,
        sides: [usize; 2],
        outer_end: [usize; 2],
        random: &mut Random,
    ) -> Result<()> {
        if !matches!(part.data[..], [Value::Image(_)]) {
            return Err(Error::unsupported("a mosaic needs samples of one image; remove the augmentation"));
        }
        let size = image_size(part)?;
        let cover = (0..2).map(|axis| sides[axis] as f32 / size[axis] as f32).fold(0.0, f32::max);
        let scale = cover * random.uniform(1.0, self.max_zoom);
        // The window of the image that fills the quadrant, in whole pixels.
        let window = [0, 1].map(|axis| ((sides[axis] as f32 / scale).round() as usize).clamp(1, size[axis]));
        let corner = [0, 1].map(|axis| if outer_end[axis] == 0 { size[axis] - window[axis] } else { 0 });
        let window = [corner[0], corner[1], window[0], window[1]];
        let map = AffineMap::window(size, window, [0, 0, sides[0], sides[1]], sides);
        transform(part, &map, &Border::with_min_visible(self.min_visible))
    }
}

fn paste_picture(canvas: &mut [u8], width: usize, part: &Sample, [left, top]: [usize; 2]) -> Result<()> {
    let [Value::Image(image)] = &part.data[..] else {
        return Err(Error::internal("a part of the mosaic has no image"));
    };
    let pixels = image.hwc_u8(PixelFormat::Rgb);
    let row = image.width() * 3;
    for (line, target) in pixels.chunks_exact(row).zip(canvas.chunks_exact_mut(width * 3).skip(top)) {
        target[left * 3..left * 3 + row].copy_from_slice(line);
    }
    Ok(())
}

/// Joins the targets of two samples of one image; of label maps, `rectangle` is taken from the second.
fn joined(mut before: Sample, part: Sample, rectangle: [usize; 4]) -> Result<Sample> {
    before.target = match (before.target, part.target) {
        (None, None) => None,
        (Some(Value::BoundingBoxList(mut boxes)), Some(Value::BoundingBoxList(more))) => {
            boxes.boxes.extend(more.boxes);
            Some(boxes.into())
        }
        (Some(Value::PoseList(mut poses)), Some(Value::PoseList(more))) => {
            poses.poses.extend(more.poses);
            Some(poses.into())
        }
        (Some(Value::Heatmap(map)), Some(Value::Heatmap(part))) => {
            Some(overlaid(map, &part, rectangle)?.into())
        }
        (before, _) => {
            let name = before.map_or("no target", |target| target.as_value_ref().value_type().name());
            return Err(Error::unsupported(format!(
                "a mosaic needs boxes, poses or label maps, all of one type, not {name}; remove the augmentation"
            )));
        }
    };
    Ok(before)
}

/// Returns a label map with a rectangle replaced from another.
fn overlaid(mut map: Heatmap, part: &Heatmap, [left, top, width, height]: [usize; 4]) -> Result<Heatmap> {
    use opendr_engine::target::HeatmapValues::Labels;
    let shape = map.shape().to_vec();
    let (&[_, columns], Labels(labels)) = (&shape[..], part.values()) else {
        return Err(Error::unsupported("a mosaic needs label maps, not scores; remove the augmentation"));
    };
    if part.shape() != shape || !matches!(map.values(), Labels(_)) {
        return Err(Error::unsupported(format!(
            "label maps of shape {shape:?} and {:?} cannot form a mosaic; give them the size of their images",
            part.shape()
        )));
    }
    let labels = labels.clone();
    let Labels(under) = map.values() else { return Ok(map) };
    let mut all = under.to_vec();
    let lines = all.chunks_exact_mut(columns).zip(labels.chunks_exact(columns)).skip(top).take(height);
    for (under, over) in lines {
        under[left..left + width].copy_from_slice(&over[left..left + width]);
    }
    map.labels_mut(&shape).copy_from_slice(&all);
    Ok(map)
}
