//! COCO with an infrared image for each colour image.

use std::path::{Path, PathBuf};

use opendr_engine::dataset::{Dataset, DatasetIterator, Sample};
use opendr_engine::target::Classes;
use opendr_engine::{Error, Result, Value, ValueType};

use super::Coco;
use crate::picture_files::is_picture;
use crate::{Format, OpenOptions, Problems, Recognition};

/// A COCO data set whose samples have two images of one view: the annotated colour image and an infrared image.
#[derive(Debug)]
pub struct CocoInfrared {
    coco: Coco,
    folder: PathBuf,
}

/// Folder of the infrared images.
const FOLDER: &str = "infrared";

impl CocoInfrared {
    /// Returns the infrared image of sample `index`: of the same name in the folder of the same part, or in
    /// `infrared` itself; its extension may differ.
    fn infrared_path(&self, index: usize) -> Result<PathBuf> {
        let colour = self.coco.picture_path(index)?;
        let part = self.coco.folder.file_name().unwrap_or_default();
        let name = colour.strip_prefix(&self.coco.folder).unwrap_or(&colour);
        for folder in [self.folder.join(part), self.folder.clone()] {
            let same = folder.join(name);
            if same.is_file() {
                return Ok(same);
            }
            let beside = same.parent().and_then(|folder| std::fs::read_dir(folder).ok());
            let mut files = beside.into_iter().flatten().flatten().map(|entry| entry.path());
            let of_name = |file: &PathBuf| file.file_stem() == colour.file_stem() && is_picture(file);
            if let Some(found) = files.find(of_name) {
                return Ok(found);
            }
        }
        Err(Error::not_found(format!(
            "{} has no infrared image: add one of its name to {}",
            colour.display(),
            self.folder.display()
        )))
    }
}

/// Returns the folder of the infrared images, beside the annotations or above them.
fn folder_of(path: &Path) -> Option<PathBuf> {
    let above = if path.is_file() { path.parent()? } else { path };
    let above = if above.ends_with("annotations") { above.parent()? } else { above };
    let folder = above.join(FOLDER);
    folder.is_dir().then_some(folder)
}

impl Dataset for CocoInfrared {}

impl DatasetIterator for CocoInfrared {
    fn len(&self) -> usize {
        self.coco.len()
    }

    fn get(&self, index: usize) -> Result<Sample> {
        let mut sample = self.coco.get(index)?;
        sample.data.push(Value::Image(opendr_vision::open(self.infrared_path(index)?)?));
        Ok(sample)
    }

    fn target(&self, index: usize) -> Result<Option<Value>> {
        self.coco.target(index)
    }

    fn name(&self, index: usize) -> String {
        self.coco.name(index)
    }

    fn path(&self, index: usize) -> Option<PathBuf> {
        self.coco.path(index)
    }

    fn image_size(&self, index: usize) -> Option<[u32; 2]> {
        self.coco.image_size(index)
    }

    fn classes(&self) -> Classes {
        self.coco.classes()
    }

    fn class_ids(&self) -> Vec<i64> {
        self.coco.class_ids()
    }

    fn id(&self, index: usize) -> Option<i64> {
        self.coco.id(index)
    }
}

impl Format for CocoInfrared {
    const NAME: &'static str = "coco_infrared";
    const ABOUT: &'static str = "COCO instances of image pairs: colour and infrared, of one view";
    const LAYOUT: &'static str = "as coco, and for val2017/a.jpg infrared/val2017/a.png (or infrared/a.png)";
    const TARGETS: &'static [ValueType] = &[ValueType::BoundingBoxList];

    fn recognise(path: &Path) -> Recognition {
        match folder_of(path) {
            Some(_) => Coco::recognise(path),
            None => Recognition::No(format!("a folder {FOLDER:?} beside the annotations or the images")),
        }
    }

    fn read_index(path: &Path, options: &OpenOptions, problems: &Problems) -> Result<Self> {
        let coco = Coco::open(path, options, problems)?;
        let folder = folder_of(path).ok_or_else(|| {
            Error::not_found(format!("{} has no folder {FOLDER:?} with infrared images", path.display()))
        })?;
        Ok(Self { coco, folder })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::folder::TemporaryFolder;

    const ANNOTATIONS: &str = r#"{"images": [{"id": 1, "file_name": "a.png", "width": 40, "height": 30},
        {"id": 2, "file_name": "b.png", "width": 20, "height": 20}, {"id": 3, "file_name": "c.png", "width": 8, "height": 8}],
        "annotations": [{"id": 1, "image_id": 1, "category_id": 5, "bbox": [1, 2, 3, 4], "area": 12, "iscrowd": 0}],
        "categories": [{"id": 5, "name": "fire"}]}"#;

    #[test]
    fn samples_have_image_pairs() {
        let scratch = TemporaryFolder::new();
        scratch.write("annotations/instances_train.json", ANNOTATIONS);
        for (name, width, height) in [("train/a.png", 40, 30), ("train/b.png", 20, 20), ("train/c.png", 8, 8)]
        {
            scratch.picture(name, width, height);
        }
        assert!(matches!(CocoInfrared::recognise(scratch.path()), Recognition::No(_)));
        let open = || CocoInfrared::open(scratch.path(), &OpenOptions::default(), &Problems::strict());
        assert!(open().unwrap_err().to_string().contains("infrared"));
        scratch.picture("infrared/train/a.png", 16, 12);
        scratch.picture("infrared/b.png", 10, 10);
        assert_eq!(CocoInfrared::recognise(scratch.path()), Recognition::Certain);
        assert_eq!(crate::recognise(scratch.path()).unwrap().name, "coco_infrared");

        let pairs = open().unwrap();
        let sizes = |index: usize| -> Vec<usize> {
            let data = pairs.get(index).unwrap().data;
            data.iter().map(|value| if let Value::Image(image) = value { image.width() } else { 0 }).collect()
        };
        assert_eq!((sizes(0), sizes(1)), (vec![40, 16], vec![20, 10]));
        let Some(Value::BoundingBoxList(boxes)) = pairs.target(0).unwrap() else { panic!() };
        assert_eq!(boxes.label(&boxes.boxes[0]), Some("fire"));
        let missing = pairs.get(2).unwrap_err().to_string();
        assert!(missing.contains("c.png") && missing.contains("infrared"), "{missing}");
    }
}
