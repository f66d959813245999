//! Annotation files: `instances_*.json`, `person_keypoints_*.json`.

use std::collections::{BTreeMap, HashMap};
use std::io::Read;

use opendr_engine::{JsonStream, Result, map_in_order};
use serde::Deserialize;

use super::batches::{Batch, Batches};
use super::entry::{Entry, needed};
use super::kind::Kind;
use crate::coco::matching::GroundTruth;

/// An annotated object.
pub(super) struct Annotation<S> {
    image: i64,
    /// Category id.
    pub class: i64,
    /// Area in square pixels, if the file has it.
    pub area: Option<f64>,
    pub crowd: bool,
    pub ignored: bool,
    pub annotated: S,
}

impl<S> Annotation<S> {
    /// Returns the object for matching; its area is `own` square pixels unless the file has it.
    pub(super) fn ground_truth(&self, own: f64) -> GroundTruth {
        GroundTruth { area: self.area.unwrap_or(own), crowd: self.crowd, ignored: self.ignored }
    }
}

/// An image of the data set.
#[derive(Deserialize)]
struct ImageRecord {
    id: i64,
    height: Option<u32>,
    width: Option<u32>,
}

#[derive(Deserialize)]
struct Category {
    id: i64,
    name: Option<String>,
}

/// Contents of an annotation file.
pub(super) struct GroundTruths<K: Kind> {
    /// Indices of the images by id, in ascending order of ids, which is their order in ties.
    images: HashMap<i64, u32>,
    /// Id and `[height, width]` by index of the image.
    listed: Vec<(i64, Option<[u32; 2]>)>,
    /// Class names by category id.
    pub classes: BTreeMap<i64, String>,
    /// Annotations by image, in the order of the file.
    annotations: Vec<Annotation<K::Annotated>>,
    /// First annotation of each image, and the end.
    starts: Vec<usize>,
    /// Number of annotations whose image or category the file does not list.
    pub unlisted: u64,
}

impl<K: Kind> GroundTruths<K> {
    /// Reads the file.
    ///
    /// # Errors
    /// Returns `Io`, or `Format` with line, byte and key.
    pub(super) fn read(file: impl Read, threads: usize) -> Result<Self> {
        let mut json = JsonStream::new(file);
        let (mut images, mut classes) = (BTreeMap::new(), BTreeMap::new());
        let mut annotations = None;
        let mut listed = [false; 2];
        json.begin_object()?;
        while let Some(key) = json.key()? {
            match key.as_str() {
                "images" => {
                    listed[0] = true;
                    each(&mut json, |image: ImageRecord| {
                        images.insert(image.id, image.height.zip(image.width).map(|(h, w)| [h, w]));
                    })?;
                }
                "categories" => {
                    listed[1] = true;
                    each(&mut json, |category: Category| {
                        let name = category.name.unwrap_or_else(|| category.id.to_string());
                        classes.insert(category.id, name);
                    })?;
                }
                "annotations" => annotations = Some(read_annotations::<K>(&mut json, threads)?),
                _ => json.skip()?,
            }
        }
        json.end()?;
        for (key, listed) in ["images", "categories"].into_iter().zip(listed) {
            needed(listed.then_some(()), key)?;
        }
        Ok(Self::sorted(images, classes, needed(annotations, "annotations")?))
    }

    fn sorted(
        images: BTreeMap<i64, Option<[u32; 2]>>,
        classes: BTreeMap<i64, String>,
        mut annotations: Vec<Annotation<K::Annotated>>,
    ) -> Self {
        let all = annotations.len();
        let listed: Vec<_> = images.into_iter().collect();
        let images: HashMap<i64, u32> = listed.iter().map(|(id, _)| *id).zip(0..).collect();
        annotations.retain(|entry| images.contains_key(&entry.image) && classes.contains_key(&entry.class));
        annotations.sort_by_key(|entry| entry.image);
        let unlisted = (all - annotations.len()) as u64;
        let mut starts = vec![0; listed.len() + 1];
        for entry in &annotations {
            starts[images[&entry.image] as usize + 1] += 1;
        }
        for at in 0..listed.len() {
            starts[at + 1] += starts[at];
        }
        Self { images, listed, classes, annotations, starts, unlisted }
    }

    /// Returns the number of images.
    pub(super) fn images(&self) -> usize {
        self.listed.len()
    }

    /// Returns the number of objects.
    pub(super) fn objects(&self) -> usize {
        self.annotations.len()
    }

    /// Returns the index of the image `id`.
    pub(super) fn index(&self, id: i64) -> Option<u32> {
        self.images.get(&id).copied()
    }

    /// Returns `[height, width]` of image `index`, if the file has it.
    pub(super) fn size(&self, index: u32) -> Option<[u32; 2]> {
        self.listed.get(index as usize).and_then(|(_, size)| *size)
    }

    /// Returns the id of image `index`.
    pub(super) fn id(&self, index: u32) -> i64 {
        self.listed.get(index as usize).map_or(-1, |(id, _)| *id)
    }

    /// Returns the objects of image `index`.
    pub(super) fn of_image(&self, index: u32) -> &[Annotation<K::Annotated>] {
        let index = index as usize;
        &self.annotations[self.starts[index]..self.starts[index + 1]]
    }
}

/// Parses every record of the next array.
fn each<T: for<'a> Deserialize<'a>>(json: &mut JsonStream<impl Read>, mut take: impl FnMut(T)) -> Result<()> {
    json.begin_array()?;
    while json.more()? {
        take(json.value()?.parse()?);
    }
    Ok(())
}

fn read_annotations<K: Kind>(
    json: &mut JsonStream<impl Read>,
    threads: usize,
) -> Result<Vec<Annotation<K::Annotated>>> {
    let mut annotations = Vec::new();
    let batches = Batches::new(json)?;
    let work = |(): &mut (), batch: Result<Batch>| -> Result<Vec<_>> {
        batch?
            .pieces()
            .map(|piece| {
                let mut entry = Entry::read(&piece, K::FIELDS)?;
                annotation::<K>(&mut entry).map_err(|error| piece.error_at(0, error.message()))
            })
            .collect()
    };
    map_in_order(&mut vec![(); threads], batches, work, |batch| -> Result<()> {
        annotations.extend(batch?);
        Ok(())
    })?;
    Ok(annotations)
}

fn annotation<K: Kind>(entry: &mut Entry) -> Result<Annotation<K::Annotated>> {
    let ignored = entry.crowd || K::is_ignored(entry);
    Ok(Annotation {
        image: needed(entry.image, "image_id")?,
        class: needed(entry.class, "category_id")?,
        area: entry.area,
        crowd: entry.crowd,
        ignored,
        annotated: K::annotated(entry)?,
    })
}
