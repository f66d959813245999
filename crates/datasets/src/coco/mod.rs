//! COCO: boxes, masks and keypoints in one JSON file, images in a folder.
//!
//! The file may be much larger than memory: one pass checks every entry and stores its offset, and entries are
//! parsed when their image is read.

mod annotation;
mod categories;
mod file_writer;
mod index;
mod infrared;
mod locate;
mod panoptic;
mod record;
mod results;
mod segment_map;
mod source;
#[cfg(test)]
mod tests;
mod write;

use std::io::Cursor;
use std::path::{Path, PathBuf};

use opendr_engine::dataset::{Dataset, DatasetIterator, Sample};
use opendr_engine::model::member_path;
use opendr_engine::target::{BoundingBoxList, Classes, PoseList};
use opendr_engine::{Error, Progress, Result, ResultExt, Value, ValueType};

use crate::picture_files::open_picture;
use crate::{Format, OpenOptions, Problems, Recognition, WriteOptions};
use index::{Entry, Index, Picture};
pub use infrared::CocoInfrared;
pub use panoptic::CocoPanoptic;
use record::AnnotationRecord;
pub use results::coco_results;
use source::Source;

/// First keys of an annotation file.
const KEYS: [&str; 4] = ["images", "annotations", "categories", "licenses"];

/// A COCO data set of instances or keypoints.
///
/// Class indices are the positions of COCO's category ids in ascending order; [`DatasetIterator::class_ids`]
/// returns the ids.
#[derive(Debug)]
pub struct Coco {
    folder: PathBuf,
    index: Index,
    source: Source,
    target: ValueType,
}

impl Entry for AnnotationRecord {
    fn image_id(&self) -> i64 {
        self.image_id
    }

    fn id(&self) -> Option<i64> {
        self.id
    }

    fn check(&self, size: [u32; 2], categories: &categories::Categories) -> Result<(), annotation::Fault> {
        self.check(size, categories)
    }
}

impl Coco {
    fn picture(&self, at: usize) -> Result<&Picture> {
        let count = self.index.pictures.len();
        let picture = self.index.pictures.get(at);
        picture.ok_or_else(|| Error::not_found(format!("no sample {at} in a data set of {count}")))
    }

    fn picture_path(&self, at: usize) -> Result<PathBuf> {
        Ok(self.folder.join(member_path(&self.source.file_name(self.picture(at)?)?)?))
    }

    fn boxes(&self, at: usize) -> Result<BoundingBoxList> {
        let mut boxes = Vec::new();
        self.source.annotations(self.index.annotations_of(at), |record: AnnotationRecord| {
            boxes.push(record.into_box(&self.index.categories));
            Ok(())
        })?;
        let image_id = Some(self.picture(at)?.id);
        Ok(BoundingBoxList { image_id, classes: self.classes(), ..BoundingBoxList::from(boxes) })
    }

    fn poses(&self, at: usize) -> Result<PoseList> {
        let mut poses = Vec::new();
        self.source.annotations(self.index.annotations_of(at), |record: AnnotationRecord| {
            poses.push(record.into_pose(&self.index.categories));
            Ok(())
        })?;
        Ok(PoseList::from(poses))
    }
}

/// Indexes the annotation file in `bytes`, as instances and as panoptic segments, for the fuzzers.
pub(crate) fn index_bytes(bytes: &[u8]) {
    let (problems, path) = (Problems::skipping(), Path::new("a.json"));
    let _ = Index::from_reader::<AnnotationRecord, _>(Cursor::new(bytes), path, &problems);
    let _ = Index::from_reader::<panoptic::Record, _>(Cursor::new(bytes), path, &problems);
}

impl Coco {
    /// Returns the JSON file of annotations that [`Coco::open`](Format::open) reads.
    ///
    /// # Errors
    /// `NotFound` if there is none, or none of the part.
    pub fn annotation_file(path: &Path, options: &OpenOptions) -> Result<PathBuf> {
        let mut files = locate::annotation_files(path);
        if !path.is_file() {
            files.retain(|file| {
                !locate::name_begins(file, &["captions_", "panoptic_", "stuff_", "image_info_"])
            });
            // Files of results may be beside annotations. Broken files are kept, to be reported.
            files.retain(|file| !locate::begins_as_list(file));
        }
        if files.is_empty() {
            let missing = "no annotation file (*.json)";
            return Err(Error::not_found(format!("{missing} in {} or its annotations/", path.display())));
        }
        let kinds = match options.target {
            Some(ValueType::PoseList) => ["person_keypoints_", "instances_"],
            _ => ["instances_", "person_keypoints_"],
        };
        let file = locate::choose(&files, options.split.as_deref(), &kinds);
        file.cloned().context(|| path.display().to_string())
    }
}

impl Dataset for Coco {}

impl DatasetIterator for Coco {
    fn len(&self) -> usize {
        self.index.pictures.len()
    }

    fn get(&self, index: usize) -> Result<Sample> {
        let (picture, path) = (self.picture(index)?, self.picture_path(index)?);
        let image = open_picture(&path, picture.size)?;
        Ok(Sample { data: vec![image.into()], target: self.target(index)? })
    }

    fn target(&self, index: usize) -> Result<Option<Value>> {
        self.picture(index)?;
        Ok(Some(match self.target {
            ValueType::PoseList => self.poses(index)?.into(),
            _ => self.boxes(index)?.into(),
        }))
    }

    fn name(&self, index: usize) -> String {
        let name = self.picture(index).and_then(|picture| self.source.file_name(picture));
        name.unwrap_or_else(|_| index.to_string())
    }

    fn path(&self, index: usize) -> Option<PathBuf> {
        self.picture_path(index).ok()
    }

    fn image_size(&self, index: usize) -> Option<[u32; 2]> {
        self.picture(index).ok().map(|picture| picture.size).filter(|size| !size.contains(&0))
    }

    fn classes(&self) -> Classes {
        self.index.categories.classes().clone()
    }

    fn class_ids(&self) -> Vec<i64> {
        self.index.categories.ids().to_vec()
    }

    fn id(&self, index: usize) -> Option<i64> {
        self.picture(index).ok().map(|picture| picture.id)
    }
}

impl Format for Coco {
    const NAME: &'static str = "coco";
    const ALIASES: &'static [&'static str] = &["ms_coco", "coco_detection", "coco_keypoints"];
    const ABOUT: &'static str = "COCO instances (boxes, polygons, RLE masks, crowds) and keypoints";
    const LAYOUT: &'static str = "annotations/instances_val2017.json (or person_keypoints_val2017.json, or one JSON \
                                  file), val2017/*.jpg (or images/val2017, images, or beside the file)";
    const TARGETS: &'static [ValueType] = &[ValueType::BoundingBoxList, ValueType::PoseList];

    fn recognise(path: &Path) -> Recognition {
        let files = locate::annotation_files(path);
        let by_name = |file: &PathBuf| {
            locate::name_begins(file, &["instances_", "person_keypoints_", "_annotations.coco"])
        };
        let own = |file: &&PathBuf| {
            locate::begins_with_key(file, &KEYS) && !locate::begins_with_key(file, &["segments_info"])
        };
        if files.iter().any(by_name) {
            Recognition::Certain
        } else if files.iter().take(64).any(|file| own(&file)) {
            Recognition::Possible
        } else {
            let folder =
                "a JSON file with \"images\", \"annotations\" and \"categories\", in annotations/ or here";
            Recognition::No(folder.to_owned())
        }
    }

    fn read_index(path: &Path, options: &OpenOptions, problems: &Problems) -> Result<Self> {
        let file = &Self::annotation_file(path, options)?;
        let target = match options.target {
            Some(target) => target,
            None if locate::name_begins(file, &["person_keypoints_"]) => ValueType::PoseList,
            None => ValueType::BoundingBoxList,
        };
        let index = Index::new::<AnnotationRecord>(file, problems)?;
        let source = Source::new(file)?;
        let first = index.pictures.first().map(|picture| source.file_name(picture)).transpose()?;
        let folder = locate::picture_folder(path, file, Path::new(&first.unwrap_or_default()));
        Ok(Self { folder, index, source, target })
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
