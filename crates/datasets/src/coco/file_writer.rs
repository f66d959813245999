//! A COCO file written entry by entry: annotations are kept in a file of their own until all images are written.

use std::fs::{self, File};
use std::io::{self, BufWriter, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use opendr_engine::dataset::DatasetIterator;
use opendr_engine::target::{Classes, Name};
use opendr_engine::{Error, Result, ResultExt};
use serde::Serialize;
use serde_json::{Value as Json, json};

use crate::class_table::ClassTable;
use crate::picture_files::Placed;

/// The file being written; an unfinished one is removed when dropped.
pub(super) struct FileWriter {
    file: PathBuf,
    /// The file, up to its images.
    main: BufWriter<File>,
    annotations: BufWriter<File>,
    pictures: u64,
    /// Number of annotations.
    pub count: u64,
}

impl FileWriter {
    /// Creates `file` and its folder.
    pub fn new(file: &Path) -> Result<Self> {
        let begin = || -> Result<_> {
            if let Some(folder) = file.parent() {
                fs::create_dir_all(folder)?;
            }
            let open = |part| {
                let path = unfinished(file, part);
                File::options()
                    .read(true)
                    .write(true)
                    .create(true)
                    .truncate(true)
                    .open(path)
                    .map(BufWriter::new)
            };
            let mut main = open("pictures")?;
            write!(main, "{{\"info\":{},\n\"images\":[", json!({"description": "written by OpenDR"}))?;
            Ok(Self { file: file.to_owned(), main, annotations: open("annotations")?, pictures: 0, count: 0 })
        };
        begin().context(|| format!("writing {}", file.display()))
    }

    /// Adds an entry of `images`.
    pub fn picture(&mut self, id: i64, Placed { name, size: [width, height] }: &Placed) -> Result<()> {
        let comma = if self.pictures > 0 { ",\n" } else { "\n" };
        self.pictures += 1;
        let entry = json!({"id": id, "file_name": name, "width": width, "height": height});
        write!(self.main, "{comma}{entry}").context(|| format!("writing {}", self.file.display()))
    }

    /// Adds an entry of `annotations`.
    pub fn annotation(&mut self, entry: &impl Serialize) -> Result<()> {
        let comma: &[u8] = if self.count > 0 { b",\n" } else { b"\n" };
        self.count += 1;
        let written = self.annotations.write_all(comma).map_err(serde_json::Error::io);
        written.and_then(|()| serde_json::to_writer(&mut self.annotations, entry)).map_err(|error| {
            Error::io(format!("an annotation cannot be written to {}", self.file.display()))
                .with_source(error)
        })
    }

    /// Joins the parts.
    pub fn finish(mut self, categories: &[Json]) -> Result<()> {
        let mut finish = || -> Result<()> {
            write!(self.main, "],\n\"categories\":{},\n\"annotations\":[", json!(categories))?;
            self.annotations.flush()?;
            let annotations = self.annotations.get_mut();
            annotations.seek(SeekFrom::Start(0))?;
            io::copy(annotations, &mut self.main)?;
            self.main.write_all(b"]}\n")?;
            self.main.flush()?;
            Ok(fs::rename(unfinished(&self.file, "pictures"), &self.file)?)
        };
        finish().context(|| format!("writing {}", self.file.display()))
    }
}

impl Drop for FileWriter {
    fn drop(&mut self) {
        for part in ["pictures", "annotations"] {
            fs::remove_file(unfinished(&self.file, part)).ok();
        }
    }
}

/// Returns the path of a part of the file while it is written.
fn unfinished(file: &Path, part: &str) -> PathBuf {
    let mut name = file.file_name().unwrap_or_default().to_owned();
    name.push(format!(".{part}.partial"));
    file.with_file_name(name)
}

/// The categories of a file that is written.
pub(super) struct CategoryIds {
    classes: ClassTable,
    /// Ids of the data set.
    ids: Vec<i64>,
}

impl CategoryIds {
    /// Starts with the categories of a data set.
    pub fn new(dataset: &dyn DatasetIterator) -> Self {
        Self { classes: ClassTable::new(&dataset.classes()), ids: dataset.class_ids() }
    }

    /// Returns the category id of a class; `own` are the class names of its target.
    pub fn category(&mut self, name: &Name, own: &Classes) -> Result<i64> {
        let number = self.classes.number(name, own)?;
        Ok(self.id(number))
    }

    /// Returns ids and names.
    pub fn iter(&self) -> impl Iterator<Item = (i64, &str)> {
        self.classes.names().iter().enumerate().map(|(number, name)| (self.id(number), name.as_str()))
    }

    /// Returns the id of a class; classes without an id in the data set get the next ones, from 1.
    fn id(&self, number: usize) -> i64 {
        let (count, most) = (self.ids.len(), self.ids.iter().copied().max().unwrap_or(0));
        self.ids.get(number).copied().unwrap_or_else(|| most + 1 + number.saturating_sub(count) as i64)
    }
}
