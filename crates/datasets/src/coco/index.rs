//! Index of a COCO file, made in one pass, with a few bytes for each entry.

use std::collections::HashSet;
use std::fs::File;
use std::io::{Read, Seek, SeekFrom};
use std::path::Path;

use opendr_engine::model::member_path;
use opendr_engine::{Error, JsonPiece, JsonStream, Result, ResultExt};
use serde::Deserialize;

use super::categories::Categories;
use super::record::PictureRecord;
use crate::{Problem, Problems};

/// An image of the file.
#[derive(Debug, Clone, Copy)]
pub(super) struct Picture {
    pub id: i64,
    pub offset: u64,
    pub length: u32,
    /// Width and height in pixels; 0 if the file does not state them.
    pub size: [u32; 2],
}

/// An annotation of the file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Annotation {
    /// Index of the image in [`Index::pictures`].
    pub picture: u32,
    pub length: u32,
    pub offset: u64,
}

/// The index of a COCO file.
#[derive(Debug, Default)]
pub(super) struct Index {
    /// Images in the order of the file.
    pub pictures: Vec<Picture>,
    /// Annotations by image, then in the order of the file.
    pub annotations: Vec<Annotation>,
    pub categories: Categories,
    /// Image indices sorted by image id.
    by_id: Vec<u32>,
}

/// The type as which an annotation is read for the index.
pub(super) trait Entry: for<'de> Deserialize<'de> {
    /// Returns the id of its image.
    fn image_id(&self) -> i64;
    /// Returns the id of the annotation, if it has one.
    fn id(&self) -> Option<i64>;
    /// Checks the annotation; an error has the invalid key and a message.
    fn check(&self, size: [u32; 2], categories: &Categories) -> Result<(), (&'static str, String)>;
}

/// A part of the file that is read after the parts it depends on.
struct Later {
    offset: u64,
    line: u64,
}

impl Index {
    /// Reads the file at `path` with annotations of type `E`; invalid entries are reported and skipped.
    ///
    /// Annotations depend on categories, which COCO writes last: annotations that precede them are skipped, and
    /// read in a second pass.
    pub fn new<E: Entry>(path: &Path, problems: &Problems) -> Result<Self> {
        let file = File::open(path).context(|| format!("opening {}", path.display()))?;
        Self::from_reader::<E, _>(file, path, problems)
    }

    /// Reads from any reader, as [`Index::new`]; `path` is used in messages.
    pub fn from_reader<E: Entry, R: Read + Seek>(
        reader: R,
        path: &Path,
        problems: &Problems,
    ) -> Result<Self> {
        let mut index = Self::default();
        let read = index.read::<E, _>(&Scan { path, problems }, reader);
        read.context(|| path.display().to_string())?;
        Ok(index)
    }

    fn read<E: Entry, R: Read + Seek>(&mut self, scan: &Scan<'_>, mut reader: R) -> Result<()> {
        let mut json = JsonStream::new(&mut reader);
        let (mut seen, mut later) = (HashSet::new(), None);
        json.begin_object().context(|| "a COCO file contains one object (a list is a file of results)")?;
        while let Some(key) = json.key()? {
            let ready = seen.contains("images") && seen.contains("categories");
            match key.as_str() {
                "images" | "annotations" | "categories" if seen.contains(&key) => {
                    return Err(json.error(&format!("the key {key:?} occurs twice; merge the files again")));
                }
                "images" => self.read_pictures(scan, &mut json)?,
                "categories" => self.categories = scan.categories(&mut json)?,
                "annotations" if ready => self.read_annotations::<E, _>(scan, &mut json)?,
                "annotations" => {
                    later = Some(Later { offset: json.offset(), line: json.line() });
                    json.skip()?;
                }
                _ => json.skip()?,
            }
            seen.insert(key);
        }
        json.end()?;
        if let Some(key) = ["images", "annotations", "categories"].iter().find(|key| !seen.contains(**key)) {
            return Err(Error::format(format!("the key {key:?} is missing; COCO files need it")));
        }
        if let Some(Later { offset, line }) = later {
            reader.seek(SeekFrom::Start(offset))?;
            self.read_annotations::<E, _>(scan, &mut JsonStream::at(reader, offset, line))?;
        }
        self.annotations.sort_unstable_by_key(|annotation| (annotation.picture, annotation.offset));
        self.annotations.shrink_to_fit();
        Ok(())
    }

    fn read_pictures<R: Read>(&mut self, scan: &Scan<'_>, json: &mut JsonStream<R>) -> Result<()> {
        json.begin_array()?;
        while json.more()? {
            let piece = json.value()?;
            let at = self.pictures.len();
            if at > u32::MAX as usize {
                return Err(Error::unsupported("more than 2^32 images; split the file"));
            }
            match picture(&piece) {
                Ok(picture) => self.pictures.push(picture),
                Err(error) => scan.report(&piece, format!("images[{at}]"), error.to_string())?,
            }
        }
        self.by_id = (0..self.pictures.len() as u32).collect();
        let pictures = &self.pictures;
        self.by_id.sort_by_key(|at| pictures[*at as usize].id);
        let again = self.by_id.windows(2).filter_map(|pair| {
            let [first, second] = [pair[0], pair[1]].map(|at| &pictures[at as usize]);
            (first.id == second.id).then_some(second)
        });
        again.into_iter().try_for_each(|picture| {
            let message = format!("the image id {} occurs twice; ids must be unique", picture.id);
            scan.problems.report(Problem::at_byte(scan.path, picture.offset, message))
        })
    }

    fn read_annotations<E: Entry, R: Read>(
        &mut self,
        scan: &Scan<'_>,
        json: &mut JsonStream<R>,
    ) -> Result<()> {
        json.begin_array()?;
        let (mut at, mut ids, mut latest) = (0u64, Vec::new(), None);
        while json.more()? {
            let piece = json.value()?;
            match self.annotation::<E>(&piece, &mut latest) {
                Ok((annotation, id)) => {
                    self.annotations.push(annotation);
                    ids.extend(id);
                }
                Err((key, message)) => {
                    let key = if key.is_empty() { key.to_owned() } else { format!(".{key}") };
                    scan.report(&piece, format!("annotations[{at}]{key}"), message)?;
                }
            }
            at += 1;
        }
        ids.sort_unstable();
        ids.chunk_by(|a, b| a == b).filter(|same| same.len() > 1).try_for_each(|same| {
            let (count, id) = (same.len(), same[0]);
            let message = format!("{count} annotations have the id {id}; ids must be unique");
            scan.problems.report(Problem::at_key(scan.path, "annotations", message))
        })
    }

    fn annotation<E: Entry>(
        &self,
        piece: &JsonPiece<'_>,
        latest: &mut Option<(i64, u32)>,
    ) -> Result<(Annotation, Option<i64>), (&'static str, String)> {
        let entry: E = piece.parse().map_err(|error| ("", error.to_string()))?;
        let image_id = entry.image_id();
        let picture = match *latest {
            Some((id, picture)) if id == image_id => picture,
            _ => self
                .picture(image_id)
                .ok_or_else(|| ("image_id", format!("the file has no image {image_id}")))?,
        };
        *latest = Some((image_id, picture));
        entry.check(self.pictures[picture as usize].size, &self.categories)?;
        let length = piece.bytes.len() as u32;
        Ok((Annotation { picture, length, offset: piece.offset }, entry.id()))
    }

    fn picture(&self, id: i64) -> Option<u32> {
        let key = |at: &u32| self.pictures.get(*at as usize).map(|picture| picture.id);
        let found = self.by_id.partition_point(|at| key(at) < Some(id));
        self.by_id.get(found).copied().filter(|at| key(at) == Some(id))
    }

    /// Returns the annotations of image `at`.
    pub fn annotations_of(&self, at: usize) -> &[Annotation] {
        let start = self.annotations.partition_point(|annotation| (annotation.picture as usize) < at);
        let rest = &self.annotations[start..];
        &rest[..rest.partition_point(|annotation| annotation.picture as usize == at)]
    }
}

fn picture(piece: &JsonPiece<'_>) -> Result<Picture> {
    let record: PictureRecord = piece.parse()?;
    member_path(&record.file_name)?;
    let size = [record.width, record.height];
    Ok(Picture { id: record.id, offset: piece.offset, length: piece.bytes.len() as u32, size })
}

/// The file being read, and where its problems are reported.
struct Scan<'a> {
    path: &'a Path,
    problems: &'a Problems,
}

impl Scan<'_> {
    fn report(&self, piece: &JsonPiece<'_>, key: String, message: String) -> Result<()> {
        // Parsing errors contain line and byte already.
        let place = match message.starts_with("line ") {
            true => String::new(),
            false => format!("line {}, byte {}: ", piece.line, piece.offset),
        };
        self.problems.report(Problem::at_key(self.path, key, place + &message))
    }

    fn categories<R: Read>(&self, json: &mut JsonStream<R>) -> Result<Categories> {
        json.begin_array()?;
        let mut records = Vec::new();
        while json.more()? {
            let piece = json.value()?;
            let key = format!("categories[{}]", records.len());
            match piece.parse() {
                Ok(record) => records.push(record),
                Err(error) => self.report(&piece, key, error.to_string())?,
            }
        }
        Ok(Categories::new(records))
    }
}
