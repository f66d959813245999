//! Files and folders of a VOC data set.

use std::path::{Path, PathBuf};

use opendr_engine::{Error, Result};

use super::annotation::Annotation;
use crate::fields::lines;
use crate::folder::{PICTURES, files_in, folders_in, path_inside, read_text};
use crate::{Problem, Problems, Recognition};

/// Names of parts; the first existing one is used.
const SPLITS: [&str; 4] = ["val", "test", "train", "trainval"];

/// The folders of a data set.
#[derive(Debug)]
pub(super) struct Layout {
    root: PathBuf,
    pub annotations: PathBuf,
    pub pictures: PathBuf,
}

/// Returns the folder itself, or the newest year in a `VOCdevkit`.
fn root_of(path: &Path) -> PathBuf {
    let folders = [path.join("VOCdevkit"), path.to_owned()];
    let years = folders.iter().filter_map(|folder| {
        let years = folders_in(folder).into_iter().filter(|name| name.starts_with("VOC2"));
        years.max().map(|year| folder.join(year))
    });
    years.into_iter().next().unwrap_or_else(|| path.to_owned())
}

pub(super) fn recognise(path: &Path) -> Recognition {
    let root = root_of(path);
    let has = |name: &str| root.join(name).is_dir();
    if has("JPEGImages") && (has("Annotations") || has("SegmentationClass")) {
        Recognition::Certain
    } else if has("Annotations") && !files_in(&root.join("Annotations"), &["xml"]).is_empty() || flat(&root) {
        Recognition::Possible
    } else {
        Recognition::No(
            "folders JPEGImages and Annotations (or SegmentationClass), or *.xml beside images".into(),
        )
    }
}

/// Returns whether XML files are beside their images, as written by labelling programs.
fn flat(root: &Path) -> bool {
    let files = files_in(root, &["xml"]);
    let annotated = |file: &String| {
        let text = read_text(&root.join(file)).unwrap_or_default();
        text.contains("<annotation") && text.contains("<filename")
    };
    files.first().is_some_and(annotated)
}

impl Layout {
    pub fn new(path: &Path) -> Result<Self> {
        let root = root_of(path);
        let (annotations, pictures) = (root.join("Annotations"), root.join("JPEGImages"));
        if annotations.is_dir() || root.join("SegmentationClass").is_dir() {
            let pictures =
                [pictures, root.join("images"), root.clone()].into_iter().find(|folder| folder.is_dir());
            return Ok(Self { annotations, pictures: pictures.unwrap_or_else(|| root.clone()), root });
        }
        if flat(&root) {
            return Ok(Self { annotations: root.clone(), pictures: root.clone(), root });
        }
        Err(Error::not_found(format!(
            "no VOC data set at {}: neither Annotations nor SegmentationClass, nor *.xml beside images",
            path.display()
        )))
    }

    pub fn has_annotations(&self) -> bool {
        self.annotations.is_dir()
    }

    /// Returns the names of the samples of a part, from `ImageSets`, or of every annotation if there is no such
    /// list.
    pub fn names(&self, split: Option<&str>, masks: bool, problems: &Problems) -> Result<Vec<String>> {
        let sets = self.root.join("ImageSets").join(if masks { "Segmentation" } else { "Main" });
        let lists = files_in(&sets, &["txt"]);
        let there = |split: &str| lists.iter().any(|list| list.strip_suffix(".txt") == Some(split));
        let split = match split {
            Some(split) if there(split) => Some(split),
            Some(split) => {
                let parts: Vec<_> = SPLITS.into_iter().filter(|split| there(split)).collect();
                let (parts, sets) = (parts.join(", "), sets.display());
                return Err(Error::not_found(format!("no part {split:?} in {sets}; the parts are: {parts}")));
            }
            None => SPLITS.into_iter().find(|split| there(split)),
        };
        let Some(split) = split else {
            let (folder, end) = if masks {
                (self.root.join("SegmentationClass"), "png")
            } else {
                (self.annotations.clone(), "xml")
            };
            let files = files_in(&folder, &[end]);
            return Ok(files.iter().filter_map(|file| Some(file.rsplit_once('.')?.0.to_owned())).collect());
        };
        let list = sets.join(split).with_extension("txt");
        let mut names = Vec::new();
        for (number, line) in lines(&read_text(&list)?) {
            let name = line.split_whitespace().next().unwrap_or_default();
            match path_inside(&self.root, name) {
                Ok(_) => names.push(name.to_owned()),
                Err(message) => problems.report(Problem::at_line(&list, number, message))?,
            }
        }
        Ok(names)
    }

    /// Reads the annotation of a sample.
    pub fn annotation(&self, name: &str) -> Result<Annotation, Problem> {
        read_annotation(&self.annotations.join(format!("{name}.xml")))
    }

    /// Returns the mask file of a sample, in `SegmentationClass` or `SegmentationObject`.
    pub fn mask(&self, kind: &str, name: &str) -> PathBuf {
        self.root.join(kind).join(format!("{name}.png"))
    }

    /// Returns the file name of a sample's image: by the sample's name, otherwise by its annotation.
    pub fn picture(&self, name: &str, filename: Option<&str>) -> Result<String, Problem> {
        let own = PICTURES.iter().map(|end| format!("{name}.{end}"));
        if let Some(file) = own.into_iter().find(|file| self.pictures.join(file).is_file()) {
            return Ok(file);
        }
        let annotation = self.annotations.join(format!("{name}.xml"));
        if let Some(file) = filename {
            let path =
                path_inside(&self.pictures, file).map_err(|message| Problem::new(&annotation, message))?;
            if path.is_file() {
                return Ok(file.to_owned());
            }
        }
        let folder = self.pictures.display();
        Err(Problem::new(annotation, format!("its image {name:?} is missing in {folder}")))
    }
}

/// Reads an annotation file.
fn read_annotation(file: &Path) -> Result<Annotation, Problem> {
    let text = read_text(file).map_err(|error| Problem::new(file, error.to_string()))?;
    Annotation::new(file, &text)
}
