//! Writer of boxes and poses as COCO.

use std::path::Path;

use opendr_engine::dataset::DatasetIterator;
use opendr_engine::target::{BoundingBox, Classes, Name, Pose, Segmentation, Skeleton};
use opendr_engine::{Error, Progress, Result, Value};
use serde::Serialize;
use serde_json::json;

use super::file_writer::{CategoryIds, FileWriter};
use crate::picture_files::{PictureWriter, Placed, split_name, write_each};
use crate::{Problems, WriteOptions};

/// COCO's names of the keypoints of [`Skeleton::Coco17`].
const JOINTS: [&str; 17] = [
    "nose",
    "left_eye",
    "right_eye",
    "left_ear",
    "right_ear",
    "left_shoulder",
    "right_shoulder",
    "left_elbow",
    "right_elbow",
    "left_wrist",
    "right_wrist",
    "left_hip",
    "right_hip",
    "left_knee",
    "right_knee",
    "left_ankle",
    "right_ankle",
];

/// An entry of `annotations`.
#[derive(Serialize)]
struct AnnotationEntry<'a> {
    id: u64,
    image_id: i64,
    category_id: i64,
    bbox: [f32; 4],
    area: f32,
    iscrowd: u8,
    segmentation: &'a Segmentation,
    #[serde(skip_serializing_if = "Option::is_none")]
    keypoints: Option<Vec<f32>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    num_keypoints: Option<usize>,
}

/// Writes `dataset` as `path/annotations/instances_SPLIT.json` (poses: `person_keypoints_SPLIT.json`) and
/// `path/SPLIT/*`. If `path` ends with `.json`, only the annotations are written.
pub(super) fn write(
    dataset: &dyn DatasetIterator,
    path: &Path,
    options: &WriteOptions,
    problems: &Problems,
    progress: &dyn Progress,
) -> Result<()> {
    let split = split_name(options)?;
    let only = path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("json"));
    let poses = (0..dataset.len()).find_map(|index| dataset.target(index).ok().flatten());
    let kind = if matches!(poses, Some(Value::PoseList(_))) { "person_keypoints" } else { "instances" };
    let (file, pictures) = if only {
        (path.to_owned(), None)
    } else {
        let file = path.join("annotations").join(format!("{kind}_{split}.json"));
        (file, Some(PictureWriter::new(dataset, path.join(split), options)?))
    };
    let (file, categories) = (FileWriter::new(&file)?, CategoryIds::new(dataset));
    let mut writer = CocoWriter { dataset, file, categories, joints: None };
    write_each(dataset, problems, progress, |index| {
        let target = dataset.target(index)?;
        writer.check(target.as_ref())?;
        let placed = match &pictures {
            Some(pictures) => pictures.place(index)?,
            None => Placed {
                name: dataset.name(index),
                size: dataset.image_size(index).ok_or_else(|| {
                    Error::invalid_input("the image size is unknown; write to a folder instead of a file")
                })?,
            },
        };
        writer.add(index, &placed, target.as_ref())
    })?;
    writer.finish()
}

struct CocoWriter<'a> {
    dataset: &'a dyn DatasetIterator,
    file: FileWriter,
    categories: CategoryIds,
    joints: Option<(usize, Skeleton)>,
}

impl CocoWriter<'_> {
    /// Checks that a target can be written, before its image is written.
    fn check(&mut self, target: Option<&Value>) -> Result<()> {
        match target {
            None => Ok(()),
            Some(Value::BoundingBoxList(list)) => list.boxes.iter().try_for_each(|found| {
                self.categories.category(&found.name, &list.classes)?;
                check_finite(found)
            }),
            Some(Value::PoseList(list)) => list.poses.iter().try_for_each(|pose| {
                self.categories.category(&name_of(pose), &Classes::default())?;
                let points = pose.keypoints.iter().filter(|point| point.confidence > 0.0);
                let wrong = points.into_iter().find(|point| !point.x.is_finite() || !point.y.is_finite());
                if let Some(point) = wrong {
                    return Err(Error::invalid_input(format!(
                        "the keypoint at {point} is not finite and cannot be written"
                    )));
                }
                pose.region.as_deref().map_or(Ok(()), check_finite)
            }),
            Some(other) => {
                let found = other.as_value_ref().value_type().name();
                Err(Error::invalid_input(format!("COCO supports boxes and poses, not {found}")))
            }
        }
    }

    fn add(&mut self, index: usize, placed: &Placed, target: Option<&Value>) -> Result<()> {
        let image_id = self.dataset.id(index).unwrap_or(index as i64 + 1);
        self.file.picture(image_id, placed)?;
        match target {
            Some(Value::BoundingBoxList(list)) => list.boxes.iter().try_for_each(|found| {
                let category_id = self.categories.category(&found.name, &list.classes)?;
                self.annotation(image_id, category_id, Some(found), None)
            }),
            Some(Value::PoseList(list)) => list.poses.iter().try_for_each(|pose| {
                let category_id = self.categories.category(&name_of(pose), &Classes::default())?;
                self.annotation(image_id, category_id, pose.region.as_deref(), Some(pose))
            }),
            _ => Ok(()),
        }
    }

    fn annotation(
        &mut self,
        image_id: i64,
        category_id: i64,
        found: Option<&BoundingBox>,
        pose: Option<&Pose>,
    ) -> Result<()> {
        let around = || pose.and_then(Pose::bounding_box).unwrap_or_default();
        let bbox = found.map_or_else(around, |found| [found.left, found.top, found.width, found.height]);
        let segment = found.and_then(|found| found.segment.as_deref());
        let (keypoints, no_outline) = (pose.map(numbers_from_pose), Segmentation::default());
        if let Some(pose) = pose {
            self.joints.get_or_insert((pose.keypoints.len(), pose.skeleton));
        }
        let labelled = |numbers: &Vec<f32>| {
            numbers.iter().skip(2).step_by(3).filter(|visibility| **visibility > 0.0).count()
        };
        self.file.annotation(&AnnotationEntry {
            id: self.file.count + 1,
            image_id,
            category_id,
            bbox,
            area: segment.map_or(bbox[2] * bbox[3], |segment| segment.area),
            iscrowd: segment.is_some_and(|segment| segment.iscrowd).into(),
            segmentation: segment.map_or(&no_outline, |segment| &segment.segmentation),
            num_keypoints: keypoints.as_ref().map(labelled),
            keypoints,
        })
    }

    fn finish(self) -> Result<()> {
        let category = |(id, name)| {
            let mut category = json!({"id": id, "name": name, "supercategory": "none"});
            if let Some((count, skeleton)) = self.joints {
                describe_joints(&mut category, count, skeleton);
            }
            category
        };
        let categories: Vec<_> = self.categories.iter().map(category).collect();
        self.file.finish(&categories)
    }
}

/// Returns the class of a person: that of its region, or the first.
fn name_of(pose: &Pose) -> Name {
    pose.region.as_ref().map_or(Name::Index(0), |region| region.name.clone())
}

fn check_finite(found: &BoundingBox) -> Result<()> {
    let segment = found.segment.as_deref();
    let polygons = segment.map(|segment| match &segment.segmentation {
        Segmentation::Polygons(polygons) => polygons.as_slice(),
        Segmentation::Rle(_) => &[],
    });
    let area = segment.map_or(0.0, |segment| segment.area);
    let mut numbers = polygons.unwrap_or_default().iter().flatten().chain([&area]);
    if found.corners().iter().all(|number| number.is_finite()) && numbers.all(|number| number.is_finite()) {
        return Ok(());
    }
    Err(Error::invalid_input(format!("a box with NaN or infinite numbers cannot be written: {found:#}")))
}

/// Returns x, y and visibility (0 not labelled, 1 occluded, 2 visible) of each keypoint.
fn numbers_from_pose(pose: &Pose) -> Vec<f32> {
    let numbers = |point: &opendr_engine::target::Keypoint| match point.confidence {
        visible if visible > 0.5 => [point.x, point.y, 2.0],
        hidden if hidden > 0.0 => [point.x, point.y, 1.0],
        _ => [0.0; 3],
    };
    pose.keypoints.iter().flat_map(numbers).collect()
}

fn describe_joints(category: &mut serde_json::Value, count: usize, skeleton: Skeleton) {
    let joints = if skeleton == Skeleton::Coco17 { &JOINTS[..] } else { skeleton.joints() };
    if joints.len() == count {
        let bones: Vec<_> = skeleton.bones().iter().map(|[from, to]| [from + 1, to + 1]).collect();
        category["keypoints"] = json!(joints);
        category["skeleton"] = json!(bones);
    }
}
