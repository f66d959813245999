//! YOLO: a text file of boxes or polygons for each image, in fractions of its size.

pub(crate) mod label;
mod layout;
#[cfg(test)]
mod tests;
mod write;
pub(crate) mod yaml;

use std::path::{Path, PathBuf};

use opendr_engine::dataset::{Dataset, DatasetIterator, Sample};
use opendr_engine::target::{BoundingBoxList, Classes};
use opendr_engine::{Error, Progress, Result, Value, ValueType};
use opendr_vision::Decoder;

use crate::fields::lines;
use crate::folder::{past_end, read_text};
use crate::{Format, OpenOptions, Problem, Problems, Recognition, WriteOptions};
use layout::Layout;

/// A YOLO data set. An image without a label file has no objects.
#[derive(Debug)]
pub struct Yolo {
    layout: Layout,
}

impl Yolo {
    fn picture_path(&self, index: usize) -> Result<PathBuf> {
        let (folder, name) =
            self.layout.pictures.get(index).ok_or_else(|| past_end(index, self.layout.pictures.len()))?;
        Ok(self.layout.folders[*folder as usize].pictures.join(name))
    }

    fn label_path(&self, index: usize) -> Result<PathBuf> {
        let (folder, name) =
            self.layout.pictures.get(index).ok_or_else(|| past_end(index, self.layout.pictures.len()))?;
        Ok(self.layout.folders[*folder as usize].labels.join(name).with_extension("txt"))
    }

    fn boxes(&self, index: usize, size: [u32; 2]) -> Result<BoundingBoxList> {
        let path = self.label_path(index)?;
        let text = if path.exists() { read_text(&path)? } else { String::new() };
        let read = |(number, line)| {
            label::box_from_line(line, size, |class| self.class(class))
                .map_err(|message| Error::from(Problem::at_line(&path, number, message)))
        };
        let boxes = lines(&text).map(read).collect::<Result<Vec<_>>>()?;
        Ok(BoundingBoxList { classes: self.classes(), ..BoundingBoxList::from(boxes) })
    }

    fn class(&self, number: i64) -> Result<i64, String> {
        let (ids, count) = (&self.layout.class_ids, self.layout.classes.len());
        let class = match ids.is_empty() {
            true => (number >= 0 && (count == 0 || number < count as i64)).then_some(number),
            false => ids.binary_search(&number).ok().map(|class| class as i64),
        };
        class.ok_or_else(|| {
            format!("has class {number}, which is not one of the {count} classes of the YAML file")
        })
    }
}

impl Dataset for Yolo {}

impl DatasetIterator for Yolo {
    fn len(&self) -> usize {
        self.layout.pictures.len()
    }

    fn get(&self, index: usize) -> Result<Sample> {
        let image = opendr_vision::open(self.picture_path(index)?)?;
        let target = self.boxes(index, [image.width() as u32, image.height() as u32])?;
        Ok(Sample { data: vec![image.into()], target: Some(target.into()) })
    }

    fn target(&self, index: usize) -> Result<Option<Value>> {
        let size = Decoder::default().size(self.picture_path(index)?)?;
        Ok(Some(self.boxes(index, size)?.into()))
    }

    fn name(&self, index: usize) -> String {
        self.layout.pictures.get(index).map_or_else(|| index.to_string(), |(_, name)| name.clone())
    }

    fn path(&self, index: usize) -> Option<PathBuf> {
        self.picture_path(index).ok()
    }

    fn classes(&self) -> Classes {
        self.layout.classes.clone()
    }

    fn class_ids(&self) -> Vec<i64> {
        self.layout.class_ids.clone()
    }
}

impl Format for Yolo {
    const NAME: &'static str = "yolo";
    const ALIASES: &'static [&'static str] = &["yolov5", "yolov8", "ultralytics", "coco128"];
    const ABOUT: &'static str = "YOLO text files: boxes or polygons, in fractions of the image";
    const LAYOUT: &'static str = "data.yaml (train, val, names), images/val/*.jpg, labels/val/*.txt (or val/images and \
                                  val/labels, or lists of images)";
    const TARGETS: &'static [ValueType] = &[ValueType::BoundingBoxList];

    fn recognise(path: &Path) -> Recognition {
        let root = layout::root_of(path);
        let labels = root.join("labels").is_dir();
        if layout::yaml_file(if path.is_file() { path } else { &root }).is_some() {
            Recognition::Certain
        } else if labels && (root.join("images").is_dir() || root.join("../images").is_dir()) {
            Recognition::Possible
        } else {
            Recognition::No(
                "a YAML file with \"names\" and \"train\" or \"val\"; or folders images and labels".into(),
            )
        }
    }

    fn read_index(path: &Path, options: &OpenOptions, problems: &Problems) -> Result<Self> {
        let layout = Layout::new(path, options.split.as_deref(), problems)?;
        let yolo = Self { layout };
        let labelled = (0..yolo.len()).any(|index| yolo.label_path(index).is_ok_and(|file| file.is_file()));
        if !labelled {
            let labels = yolo.layout.folders.first().map(|folder| folder.labels.display().to_string());
            return Err(Error::not_found(format!(
                "none of the {} images of {} has a label file in {}",
                yolo.len(),
                path.display(),
                labels.unwrap_or_default()
            )));
        }
        Ok(yolo)
    }

    fn write(
        dataset: &dyn DatasetIterator,
        path: &Path,
        options: &WriteOptions,
        problems: &Problems,
        progress: &dyn Progress,
    ) -> Result<()> {
        write::write(dataset, path, options, problems, progress)
    }
}
