//! Image files of a data set: reading, and copying into another data set.

use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};

use opendr_engine::data::Image;
use opendr_engine::dataset::DatasetIterator;
use opendr_engine::model::member_path;
use opendr_engine::{Error, Result, ResultExt, Value};
use opendr_vision::Decoder;

use crate::folder::{PICTURES, has_extension};
use crate::{Problem, Problems, WriteOptions};

/// Returns whether a file is an image, by its extension.
pub(crate) fn is_picture(path: &Path) -> bool {
    has_extension(&path.to_string_lossy(), PICTURES)
}

/// Reads the image at `path` and checks it against the size in the annotations (0 if unknown).
pub(crate) fn open_picture(path: &Path, size: [u32; 2]) -> Result<Image> {
    let image = opendr_vision::open(path)?;
    let actual = [image.width() as u32, image.height() as u32];
    if !size.contains(&0) && actual != size {
        let ([width, height], [annotated_width, annotated_height]) = (actual, size);
        let path = path.display();
        return Err(Error::format(format!(
            "{path} has {width}x{height} pixels, its annotation is for {annotated_width}x{annotated_height}"
        )));
    }
    Ok(image)
}

/// Calls `each` with the samples of `dataset` to write them; samples that fail are reported and skipped.
pub(crate) fn write_each(
    dataset: &dyn DatasetIterator,
    problems: &Problems,
    progress: &dyn opendr_engine::Progress,
    mut each: impl FnMut(usize) -> Result<()>,
) -> Result<()> {
    progress.begin("writing", Some(dataset.len() as u64), opendr_engine::Unit::Items);
    let written = (0..dataset.len()).take_while(|_| !progress.stopped()).try_for_each(|index| {
        progress.advance(1);
        each(index).or_else(|error| {
            let file = dataset.path(index).unwrap_or_else(|| dataset.name(index).into());
            problems.report(Problem::new(file, error.to_string()))
        })
    });
    progress.end();
    written
}

/// Returns the name of the part, checked to be a folder name.
pub(crate) fn split_name(options: &WriteOptions) -> Result<&str> {
    let split = options.split.as_deref().unwrap_or("train");
    if split.contains('/') || member_path(split).is_err() {
        return Err(Error::invalid_param(format!(
            "{split:?} is not a valid name of a part; use one like \"train\""
        )));
    }
    Ok(split)
}

/// An image written into a data set.
pub(crate) struct Placed {
    /// File name in its folder.
    pub name: String,
    /// Width and height in pixels.
    pub size: [u32; 2],
}

/// Copies the images of a data set into a folder.
pub(crate) struct PictureWriter<'a> {
    dataset: &'a dyn DatasetIterator,
    folder: PathBuf,
    link: bool,
}

impl<'a> PictureWriter<'a> {
    /// Creates `folder`.
    pub fn new(dataset: &'a dyn DatasetIterator, folder: PathBuf, options: &WriteOptions) -> Result<Self> {
        fs::create_dir_all(&folder).context(|| format!("making {}", folder.display()))?;
        Ok(Self { dataset, folder, link: options.link })
    }

    /// Copies or links the file of a sample; without a file, encodes its image.
    ///
    /// # Errors
    /// If the image cannot be read, or a file of its name exists.
    pub fn place(&self, index: usize) -> Result<Placed> {
        match self.dataset.path(index).filter(|path| is_picture(path)) {
            Some(source) => {
                let size = match self.dataset.image_size(index) {
                    Some(size) => size,
                    None => Decoder::default().size(&source)?,
                };
                let name = self.name(index, source.extension().and_then(|end| end.to_str()).unwrap_or("jpg"));
                let target = self.folder.join(&name);
                self.copy_or_link(&source, &target).context(|| format!("writing {}", target.display()))?;
                Ok(Placed { name, size })
            }
            None => self.encode(index),
        }
    }

    fn encode(&self, index: usize) -> Result<Placed> {
        let sample = self.dataset.get(index)?;
        let image = sample.data.iter().find_map(|datum| match datum {
            Value::Image(image) => Some(image),
            _ => None,
        });
        let image = image.ok_or_else(|| Error::invalid_input("the sample has no image"))?;
        let name = self.name(index, "png");
        opendr_vision::save(image, self.folder.join(&name))?;
        Ok(Placed { name, size: [image.width() as u32, image.height() as u32] })
    }

    /// Returns the name of the sample without folders: `"a/b.jpg"` becomes `"a_b.jpg"`.
    fn name(&self, index: usize, extension: &str) -> String {
        let name = self.dataset.name(index);
        let path = Path::new(&name);
        let stem = if is_picture(path) { path.with_extension("") } else { path.to_owned() };
        let parts = stem.components().filter_map(|part| match part {
            std::path::Component::Normal(part) => part.to_str(),
            _ => None,
        });
        let flat = parts.collect::<Vec<_>>().join("_").replace(|c: char| c.is_control() || c == '\\', "_");
        format!("{}.{extension}", if flat.is_empty() { index.to_string() } else { flat })
    }

    fn copy_or_link(&self, source: &Path, target: &Path) -> Result<()> {
        // A link to a link would break if the first is moved.
        let source = fs::canonicalize(source).context(|| format!("opening {}", source.display()))?;
        if self.link && fs::hard_link(&source, target).is_ok() {
            return Ok(());
        }
        let mut from = File::open(&source)?;
        if target.exists() {
            return Err(Error::io("the file exists already; write into an empty folder"));
        }
        let copied = File::create_new(target).and_then(|mut to| io::copy(&mut from, &mut to));
        copied.map(drop).map_err(Error::from)
    }
}
