//! Writer of boxes as YOLO's label files.

use std::borrow::Cow;
use std::fmt::Write;
use std::path::Path;

use opendr_engine::dataset::DatasetIterator;
use opendr_engine::target::{BoundingBoxList, Segmentation};
use opendr_engine::{Error, Progress, Result, Value};

use super::label::line_from_box;
use crate::class_table::ClassTable;
use crate::folder::{folders_in, write_file};
use crate::picture_files::{PictureWriter, split_name, write_each};
use crate::{Problems, WriteOptions};

/// Writes `images/SPLIT/*`, `labels/SPLIT/*.txt` and `data.yaml`.
///
/// Trainers expect either boxes or polygons in all files of a data set. Polygons are written if every object of the
/// first image with objects has polygons. YOLO does not support crowds; they are skipped.
pub(super) fn write(
    dataset: &dyn DatasetIterator,
    path: &Path,
    options: &WriteOptions,
    problems: &Problems,
    progress: &dyn Progress,
) -> Result<()> {
    let split = split_name(options)?;
    let pictures = PictureWriter::new(dataset, path.join("images").join(split), options)?;
    let labels = path.join("labels").join(split);
    let mut classes = ClassTable::new(&dataset.classes());
    let mut outlined = None;
    write_each(dataset, problems, progress, |index| {
        let target = dataset.target(index)?;
        let list = boxes_of(target.as_ref())?;
        if !list.boxes.is_empty() {
            outlined.get_or_insert_with(|| has_outlines(&list));
        }
        let numbers = list.boxes.iter().map(|found| classes.number(&found.name, &list.classes));
        let numbers = numbers.collect::<Result<Vec<_>>>()?;
        let placed = pictures.place(index)?;
        let outlined = outlined.unwrap_or(false);
        let lines = list.boxes.iter().zip(numbers);
        let lines = lines.filter_map(|(found, class)| line_from_box(found, class, placed.size, outlined));
        let text: String = lines.flat_map(|line| [line, "\n".to_owned()]).collect();
        write_file(&labels.join(&placed.name).with_extension("txt"), text.as_bytes())
    })?;
    write_file(&path.join("data.yaml"), yaml(path, split, &classes).as_bytes())
}

fn boxes_of(target: Option<&Value>) -> Result<Cow<'_, BoundingBoxList>> {
    match target {
        None => Ok(Cow::Owned(BoundingBoxList::default())),
        Some(Value::BoundingBoxList(list)) => Ok(Cow::Borrowed(list)),
        Some(other) => {
            let found = other.as_value_ref().value_type().name();
            Err(Error::invalid_input(format!("YOLO supports boxes, not {found}")))
        }
    }
}

fn has_outlines(list: &BoundingBoxList) -> bool {
    let segments = list.boxes.iter().map(|found| found.segment.as_deref());
    let mut segments = segments.filter(|segment| !segment.is_some_and(|segment| segment.iscrowd)).peekable();
    let outline = |segmentation: &Segmentation| matches!(segmentation, Segmentation::Polygons(polygons) if !polygons.is_empty());
    segments.peek().is_some()
        && segments.all(|segment| segment.is_some_and(|segment| outline(&segment.segmentation)))
}

fn yaml(path: &Path, split: &str, classes: &ClassTable) -> String {
    let there = folders_in(&path.join("images"));
    let named =
        |wanted: &str| there.iter().find(|part| part.starts_with(wanted)).map_or(split, String::as_str);
    // Trainers need both keys.
    let mut text = format!("train: images/{}\nval: images/{}\n", named("train"), named("val"));
    if let Some(test) = there.iter().find(|part| part.starts_with("test")) {
        let _ = writeln!(text, "test: images/{test}");
    }
    text.push_str("names:\n");
    for (number, name) in classes.names().iter().enumerate() {
        let name = name.replace(|c: char| c.is_control(), " ").replace('\\', "/").replace('"', "'");
        let _ = writeln!(text, "  {number}: \"{name}\"");
    }
    text
}
