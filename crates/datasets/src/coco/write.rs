//! COCO files written sample by sample: annotations wait in a file of their own for the pictures to end.

use std::fs::{self, File};
use std::io::{self, BufWriter, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use opendr_engine::dataset::DatasetIterator;
use opendr_engine::target::{BoundingBox, BoundingBoxList, Name, Pose, Segmentation, Skeleton};
use opendr_engine::{Error, Progress, Result, ResultExt, Value};
use serde::Serialize;
use serde_json::json;

use crate::class_table::ClassTable;
use crate::picture_files::{PictureWriter, Placed, split_name, write_each};
use crate::{Problems, WriteOptions};

/// COCO's names of the joints of [`Skeleton::Coco17`].
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
/// `path/SPLIT/*`; to a path that ends with `.json`, only the annotations.
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
    let mut writer = CocoWriter::new(&file, dataset)?;
    write_each(dataset, problems, progress, |index| {
        let target = dataset.target(index)?;
        writer.check(target.as_ref())?;
        let placed = match &pictures {
            Some(pictures) => pictures.place(index)?,
            None => Placed {
                name: dataset.name(index),
                size: dataset.picture_size(index).ok_or_else(|| {
                    Error::invalid_input(
                        "the size of the picture is not known; write to a folder, not to a file",
                    )
                })?,
            },
        };
        writer.add(index, placed, target.as_ref())
    })?;
    writer.finish().context(|| format!("writing {}", file.display()))
}

struct CocoWriter<'a> {
    dataset: &'a dyn DatasetIterator,
    file: PathBuf,
    /// The file, up to its pictures.
    main: BufWriter<File>,
    annotations: BufWriter<File>,
    pictures: u64,
    count: u64,
    classes: ClassTable,
    class_ids: Vec<i64>,
    joints: Option<(usize, Skeleton)>,
}

impl<'a> CocoWriter<'a> {
    fn new(file: &Path, dataset: &'a dyn DatasetIterator) -> Result<Self> {
        let make = || -> Result<_> {
            if let Some(folder) = file.parent() {
                fs::create_dir_all(folder)?;
            }
            let open = |path| File::options().read(true).write(true).create(true).truncate(true).open(path);
            let mut main = BufWriter::new(open(partial(file, "main"))?);
            write!(main, "{{\"info\":{},\n\"images\":[", json!({"description": "written by OpenDR"}))?;
            Ok((main, BufWriter::new(open(partial(file, "annotations"))?)))
        };
        let (main, annotations) = make().context(|| format!("writing {}", file.display()))?;
        Ok(Self {
            dataset,
            file: file.to_owned(),
            main,
            annotations,
            pictures: 0,
            count: 0,
            classes: ClassTable::new(&dataset.classes()),
            class_ids: dataset.class_ids(),
            joints: None,
        })
    }

    /// Whether a target can be written, found out before its picture is.
    fn check(&mut self, target: Option<&Value>) -> Result<()> {
        match target {
            None | Some(Value::PoseList(_)) => Ok(()),
            Some(Value::BoundingBoxList(list)) => {
                list.boxes.iter().try_for_each(|found| self.category(list, &found.name).map(drop))
            }
            Some(other) => {
                let found = other.as_value_ref().value_type().name();
                Err(Error::invalid_input(format!("COCO holds boxes and poses, no {found}")))
            }
        }
    }

    fn add(&mut self, index: usize, Placed { name, size }: Placed, target: Option<&Value>) -> Result<()> {
        let image_id = self.dataset.id(index).unwrap_or(index as i64 + 1);
        let comma = if self.pictures > 0 { ",\n" } else { "\n" };
        let entry = json!({"id": image_id, "file_name": name, "width": size[0], "height": size[1]});
        write!(self.main, "{comma}{entry}")?;
        self.pictures += 1;
        match target {
            Some(Value::BoundingBoxList(list)) => list.boxes.iter().try_for_each(|found| {
                let category_id = self.category(list, &found.name)?;
                self.annotation(image_id, category_id, Some(found), None)
            }),
            Some(Value::PoseList(list)) => list.poses.iter().try_for_each(|pose| {
                let name = pose.region.as_ref().map_or(Name::Index(0), |region| region.name.clone());
                let category_id = self.category(&BoundingBoxList::default(), &name)?;
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
        self.count += 1;
        let entry = AnnotationEntry {
            id: self.count,
            image_id,
            category_id,
            bbox,
            area: segment.map_or(bbox[2] * bbox[3], |segment| segment.area),
            iscrowd: segment.is_some_and(|segment| segment.iscrowd).into(),
            segmentation: segment.map_or(&no_outline, |segment| &segment.segmentation),
            num_keypoints: keypoints
                .as_ref()
                .map(|numbers| numbers.iter().skip(2).step_by(3).filter(|visible| **visible > 0.0).count()),
            keypoints,
        };
        if !bbox.iter().all(|number| number.is_finite()) {
            return Err(Error::invalid_input(format!(
                "a box at {bbox:?} cannot be written; its numbers must be finite"
            )));
        }
        self.annotations.write_all(if self.count > 1 { b",\n" } else { b"\n" })?;
        serde_json::to_writer(&mut self.annotations, &entry)
            .map_err(|error| Error::io("the annotation cannot be written").with_source(error))
    }

    /// The data set's own number of a class.
    fn category(&mut self, list: &BoundingBoxList, name: &Name) -> Result<i64> {
        let number = self.classes.number(name, &list.classes)?;
        Ok(self.category_id(number))
    }

    /// Classes without a number of the data set's own get the next ones, from 1.
    fn category_id(&self, number: usize) -> i64 {
        let (count, most) = (self.class_ids.len(), self.class_ids.iter().copied().max().unwrap_or(0));
        self.class_ids.get(number).copied().unwrap_or_else(|| most + 1 + number.saturating_sub(count) as i64)
    }

    fn finish(mut self) -> Result<()> {
        let mut categories = Vec::new();
        for (number, name) in self.classes.names().iter().enumerate() {
            let id = self.category_id(number);
            let mut category = json!({"id": id, "name": name, "supercategory": "none"});
            if let Some((count, skeleton)) = self.joints {
                describe_joints(&mut category, count, skeleton);
            }
            categories.push(category);
        }
        write!(self.main, "],\n\"categories\":{},\n\"annotations\":[", json!(categories))?;
        let mut annotations = self.annotations.into_inner().map_err(io::IntoInnerError::into_error)?;
        annotations.seek(SeekFrom::Start(0))?;
        io::copy(&mut annotations, &mut self.main)?;
        self.main.write_all(b"]}\n")?;
        self.main.flush()?;
        fs::rename(partial(&self.file, "main"), &self.file)?;
        Ok(fs::remove_file(partial(&self.file, "annotations"))?)
    }
}

/// Where a part of the file is until the whole is there.
fn partial(file: &Path, part: &str) -> PathBuf {
    let mut name = file.file_name().unwrap_or_default().to_owned();
    name.push(format!(".{part}.partial"));
    file.with_file_name(name)
}

/// x, y and visibility (0 not labelled, 1 hidden, 2 visible) of each joint.
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
