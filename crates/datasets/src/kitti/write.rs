//! Writer of boxes in the format of KITTI's detection benchmark.

use std::fs;
use std::path::Path;

use opendr_engine::dataset::{DatasetIterator, Sample};
use opendr_engine::target::{BoundingBox3DList, Classes, Name};
use opendr_engine::{Error, Progress, Result, Value};

use crate::folder::{path_inside, write_file, write_picture};
use crate::kitti::labels::box_from_flat;
use crate::kitti::{kitti_from_calibration, velodyne_from_cloud};
use crate::picture_files::write_each;
use crate::{Problems, WriteOptions};

/// Writes `dataset`; scenes are numbered from 0.
pub(super) fn write(
    dataset: &dyn DatasetIterator,
    path: &Path,
    options: &WriteOptions,
    problems: &Problems,
    progress: &dyn Progress,
) -> Result<()> {
    let part = match options.split.as_deref() {
        None | Some("train") => "training",
        Some("test") => "testing",
        Some(other) => other,
    };
    let folder = path_inside(path, part).map_err(Error::invalid_param)?;
    write_each(dataset, problems, progress, |index| {
        let from = dataset.path(index);
        write_scene(&dataset.get(index)?, &folder, index, from.as_deref(), options.link)
    })
}

fn write_scene(sample: &Sample, folder: &Path, index: usize, from: Option<&Path>, link: bool) -> Result<()> {
    let file = |kind: &str, extension: &str| folder.join(kind).join(format!("{index:06}.{extension}"));
    if let Some(target) = &sample.target {
        write_file(&file("label_2", "txt"), label_text(target)?.as_bytes())?;
    }
    for datum in &sample.data {
        match datum {
            Value::Image(image) => write_picture(from, image, &file("image_2", "png"), link)?,
            Value::PointCloud(cloud) => write_file(&file("velodyne", "bin"), &velodyne_from_cloud(cloud))?,
            Value::PointCloudWithCalibration(scan) => {
                write_file(&file("velodyne", "bin"), &velodyne_from_cloud(&scan.cloud))?;
                write_file(&file("calib", "txt"), kitti_from_calibration(&scan.calibration).as_bytes())?;
            }
            other => {
                let name = other.as_value_ref().value_type().name();
                return Err(Error::invalid_input(format!(
                    "KITTI supports images and point clouds, not {name}"
                )));
            }
        }
    }
    fs::create_dir_all(folder.join("label_2"))?;
    Ok(())
}

/// Returns lines of fifteen fields, since annotations have no score.
fn label_text(target: &Value) -> Result<String> {
    let boxes = match target {
        Value::BoundingBox3DList(boxes) => {
            let mut boxes = boxes.clone();
            let classes = boxes.classes.clone();
            boxes.boxes.iter_mut().for_each(|found| found.name = labelled(&found.name, &classes));
            boxes
        }
        Value::BoundingBoxList(list) => {
            let flat =
                list.boxes.iter().map(|found| box_from_flat(found, labelled(&found.name, &list.classes)));
            BoundingBox3DList::from(flat.collect::<Vec<_>>())
        }
        other => {
            let name = other.as_value_ref().value_type().name();
            return Err(Error::invalid_input(format!("KITTI supports boxes, not {name}")));
        }
    };
    let numbers = boxes.boxes.iter().flat_map(|found| {
        let angles = [found.alpha, found.rotation_y, found.truncated];
        found.bbox2d.into_iter().chain(found.dimensions).chain(found.location).chain(angles)
    });
    if !numbers.clone().all(f32::is_finite) {
        return Err(Error::invalid_input("a box has a value that is NaN or infinite; remove it"));
    }
    let text = boxes.kitti_text();
    let lines = text.lines().filter_map(|line| line.rsplit_once(' '));
    Ok(lines.map(|(label, _)| format!("{label}\n")).collect())
}

fn labelled(name: &Name, classes: &Classes) -> Name {
    classes.label(name).map_or_else(|| name.clone(), Name::from)
}
