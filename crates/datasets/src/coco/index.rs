//! Where what stands in a COCO file: one pass over it, a few bytes kept of each entry.

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

/// A picture of the file.
#[derive(Debug, Clone, Copy)]
pub(super) struct Picture {
    pub id: i64,
    pub offset: u64,
    pub length: u32,
    /// Width and height in pixels; 0 when the file does not tell.
    pub size: [u32; 2],
}

/// An annotation of the file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Annotation {
    /// Number of the picture among [`Index::pictures`].
    pub picture: u32,
    pub length: u32,
    pub offset: u64,
}

/// The index of a COCO file.
#[derive(Debug, Default)]
pub(super) struct Index {
    /// In the order of the file.
    pub pictures: Vec<Picture>,
    /// By picture, then in the order of the file.
    pub annotations: Vec<Annotation>,
    pub categories: Categories,
    /// Numbers of the pictures by their ids.
    by_id: Vec<u32>,
}

/// What an annotation is read as while it is indexed.
pub(super) trait Entry: for<'de> Deserialize<'de> {
    /// Of its picture.
    fn image_id(&self) -> i64;
    /// Of the annotation, where it has one.
    fn id(&self) -> Option<i64>;
    /// What is wrong with it, by key.
    fn check(&self, size: [u32; 2], categories: &Categories) -> Result<(), (&'static str, String)>;
}

/// A stretch of the file that is read after what it depends on.
struct Later {
    offset: u64,
    line: u64,
}

impl Index {
    /// Reads the file at `path`, its annotations as `E`; broken entries are reported and left out.
    ///
    /// Entries depend on categories, which COCO writes last: annotations that come too early are passed over, and
    /// read when the rest is known.
    pub fn new<E: Entry>(path: &Path, problems: &Problems) -> Result<Self> {
        let file = File::open(path).context(|| format!("opening {}", path.display()))?;
        Self::from_reader::<E, _>(file, path, problems)
    }

    /// As [`Index::new`], from any reader; `path` is what problems call it.
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
        json.begin_object().context(|| "a COCO file holds one object (a list is a file of results)")?;
        while let Some(key) = json.key()? {
            let ready = seen.contains("images") && seen.contains("categories");
            match key.as_str() {
                "images" | "annotations" | "categories" if seen.contains(&key) => {
                    return Err(json.error(&format!("a second key {key:?}; join the files anew")));
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
            return Err(Error::format(format!("there is no key {key:?}; COCO files have one")));
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
                return Err(Error::unsupported("more than 2^32 pictures; split the file"));
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
            let message = format!("a second picture with id {}; give each its own", picture.id);
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
            let message = format!("{count} annotations have the id {id}; give each its own");
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
                .ok_or_else(|| ("image_id", format!("there is no picture {image_id}")))?,
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

    /// The annotations of picture number `at`.
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

/// The file that is read, and whom to tell what is broken in it.
struct Scan<'a> {
    path: &'a Path,
    problems: &'a Problems,
}

impl Scan<'_> {
    fn report(&self, piece: &JsonPiece<'_>, key: String, message: String) -> Result<()> {
        // Errors of parsing tell line and byte themselves.
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
