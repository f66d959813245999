//! Annotations as boxes or poses, with checks against their image.

use opendr_engine::target::{BoundingBox, Keypoint, Name, Pose, Segment, Segmentation, Skeleton};

use super::categories::Categories;
use super::record::AnnotationRecord;
use crate::picture_box::leaves_picture;

/// An invalid key, and its error.
pub(super) type Fault = (&'static str, String);

impl AnnotationRecord {
    /// Checks the values for an image of `size` (`[0, 0]` if it is unknown).
    pub fn check(&self, size: [u32; 2], categories: &Categories) -> Result<(), Fault> {
        let Some(class) = categories.class(self.category_id) else {
            let (id, count) = (self.category_id, categories.ids().len());
            return Err(("category_id", format!("{id} is not one of the {count} categories of the file")));
        };
        if let Some(bbox) = self.bbox {
            check_box(bbox, size)?;
        } else if self.keypoints.is_empty() {
            return Err(("bbox", "the annotation has none; add [left, top, width, height]".to_owned()));
        }
        if let Some(area) = self.area.filter(|area| !(0.0..f32::INFINITY).contains(area)) {
            return Err(("area", format!("{area} is not a valid number of square pixels")));
        }
        self.check_segmentation(size)?;
        self.check_keypoints(categories.keypoints(class))
    }

    fn check_segmentation(&self, [width, height]: [u32; 2]) -> Result<(), Fault> {
        let wrong = match &self.segmentation {
            Some(Segmentation::Polygons(polygons)) => polygons.iter().find_map(|polygon| {
                if polygon.len() < 6 || polygon.len() % 2 == 1 {
                    let count = polygon.len();
                    return Some(format!(
                        "a polygon of {count} numbers; it needs x and y of at least 3 corners"
                    ));
                }
                let infinite = polygon.iter().find(|number| !number.is_finite())?;
                Some(format!("a corner at {infinite}; coordinates must be finite"))
            }),
            Some(Segmentation::Rle(rle)) if width > 0 && rle.size() != [height, width] => {
                let [rows, columns] = rle.size();
                Some(format!("a mask of {columns}x{rows} pixels in an image of {width}x{height}"))
            }
            _ => None,
        };
        wrong.map_or(Ok(()), |wrong| Err(("segmentation", wrong)))
    }

    fn check_keypoints(&self, expected: usize) -> Result<(), Fault> {
        let count = self.keypoints.len();
        if !count.is_multiple_of(3) || (expected > 0 && count > 0 && count != 3 * expected) {
            let expected = if expected > 0 { 3 * expected } else { count.next_multiple_of(3) };
            return Err((
                "keypoints",
                format!("{count} numbers instead of {expected}: x, y, visibility of each keypoint"),
            ));
        }
        let wrong = |point: &&[f32]| {
            !point.iter().all(|number| number.is_finite()) || ![0.0, 1.0, 2.0].contains(&point[2])
        };
        match self.keypoints.chunks_exact(3).find(wrong) {
            None => Ok(()),
            Some(point) => Err(("keypoints", format!("{point:?} is not x, y and visibility of 0, 1 or 2"))),
        }
    }

    /// Converts to a box. It has a [`Segment`] if the entry has a mask, an area of its own, or is a crowd.
    pub fn into_box(self, categories: &Categories) -> BoundingBox {
        let [left, top, width, height] = self.bbox.unwrap_or_default();
        let class = categories.class(self.category_id).map_or(-1, |class| class as i64);
        let own = self.area.filter(|area| *area != width * height);
        let segment = (self.segmentation.is_some() || self.iscrowd || own.is_some()).then(|| {
            Box::new(Segment {
                segmentation: self.segmentation.unwrap_or_default(),
                area: self.area.unwrap_or(width * height),
                iscrowd: self.iscrowd,
            })
        });
        BoundingBox { segment, ..BoundingBox::new(Name::Index(class), left, top, width, height, 1.0) }
    }

    /// Converts to a pose. The confidence of a keypoint is half its visibility (0 not labelled, 0.5 occluded, 1
    /// visible); keypoints that are not labelled are [`Keypoint::MISSING`].
    pub fn into_pose(mut self, categories: &Categories) -> Pose {
        let points = std::mem::take(&mut self.keypoints);
        let keypoint = |point: &[f32]| match point {
            [x, y, visibility] if *visibility > 0.0 => {
                Keypoint { x: *x, y: *y, confidence: *visibility / 2.0 }
            }
            _ => Keypoint::MISSING,
        };
        let skeleton = if points.len() == 51 { Skeleton::Coco17 } else { Skeleton::default() };
        let region = self.bbox.is_some().then(|| Box::new(self.into_box(categories)));
        let keypoints = points.chunks_exact(3).map(keypoint).collect();
        Pose { keypoints, confidence: 1.0, id: None, skeleton, region }
    }
}

/// Checks that `[left, top, width, height]` is a box inside an image of `size`.
pub(super) fn check_box(bbox: [f32; 4], size: [u32; 2]) -> Result<(), Fault> {
    if !bbox.iter().all(|number| number.is_finite()) || bbox[2] < 0.0 || bbox[3] < 0.0 {
        return Err(("bbox", format!("{bbox:?} is not a left, top, width and height")));
    }
    if leaves_picture(bbox, size) {
        let [width, height] = size;
        return Err(("bbox", format!("{bbox:?} lies outside of its image of {width}x{height} pixels")));
    }
    Ok(())
}
