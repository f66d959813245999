//! Conversion of boxes with masks to maps of labels.

use std::collections::HashMap;

use opendr_engine::target::{BoundingBox, BoundingBoxList, Heatmap, Name, Rle, Segmentation};

use super::label::{LABEL_DIVISOR, VOID_LABEL};

/// Maximum number of pixels, the same as for single masks.
const MOST_PIXELS: u64 = 1 << 28;

/// Converts a list of boxes with run-length encoded masks of one size to a map of labels; the first mask of the list is on
/// top. Objects of a class are numbered from 1; crowds of the ground truth are object 0. An empty list gives an empty map.
pub(super) fn labels_from_masks(list: &BoundingBoxList, is_truth: bool) -> Option<Heatmap> {
    let Some(first) = list.boxes.first() else { return Some(Heatmap::default()) };
    let size = mask_of_box(first)?.0.size();
    if u64::from(size[0]) * u64::from(size[1]) > MOST_PIXELS {
        return None;
    }
    let [height, width] = size.map(|side| side as usize);
    let mut objects = HashMap::<u32, u32>::new();
    let mut segments = Vec::with_capacity(list.boxes.len());
    for found in &list.boxes {
        let (mask, is_crowd) = mask_of_box(found)?;
        let class = class_of_box(found, list)?;
        let object = match is_truth && is_crowd {
            true => 0,
            false => *objects.entry(class).and_modify(|count| *count += 1).or_insert(1),
        };
        if mask.size() != size || object >= LABEL_DIVISOR {
            return None;
        }
        segments.push((mask, class.checked_mul(LABEL_DIVISOR)?.checked_add(object)?));
    }
    let mut labels = vec![VOID_LABEL; height * width];
    for (mask, label) in segments.into_iter().rev() {
        paint(&mut labels, mask, label);
    }
    let mut map = Heatmap::from_labels(labels, &[height, width]).ok()?;
    map.classes = list.classes.clone();
    Some(map)
}

/// Writes a label into the pixels of a mask. Runs are in column order, background first.
fn paint(labels: &mut [u32], mask: &Rle, label: u32) {
    let [height, width] = mask.size().map(|side| side as usize);
    let mut start = 0;
    for (at, run) in mask.counts().iter().enumerate() {
        let end = start + *run as usize;
        if at % 2 == 1 {
            for pixel in start..end {
                if let Some(place) = labels.get_mut(pixel % height * width + pixel / height) {
                    *place = label;
                }
            }
        }
        start = end;
    }
}

fn mask_of_box(found: &BoundingBox) -> Option<(&Rle, bool)> {
    let segment = found.segment.as_deref()?;
    match &segment.segmentation {
        Segmentation::Rle(mask) => Some((mask, segment.iscrowd)),
        Segmentation::Polygons(_) => None,
    }
}

fn class_of_box(found: &BoundingBox, list: &BoundingBoxList) -> Option<u32> {
    let class = match &found.name {
        Name::Index(index) => *index,
        Name::Label(label) => list.classes.index(label)?,
    };
    u32::try_from(class).ok()
}
