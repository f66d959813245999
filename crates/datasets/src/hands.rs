//! Gestures in colour and depth: the HANDS data set, and image pairs in folders of classes.
//!
//! Source: C. Nuzzi et al., HANDS: an RGB-D dataset of static hand-gestures for human-robot interaction, Data in Brief 2021.

use std::path::{Path, PathBuf};

use opendr_engine::dataset::{Dataset, DatasetIterator, Sample};
use opendr_engine::target::{Category, Classes};
use opendr_engine::{Error, Progress, Result, Value, ValueType};
use opendr_vision::{Decoder, save_depth};

use crate::folder::{PICTURES, files_in, folders_in, name_of, past_end, path_inside, write_picture};
use crate::picture_files::write_each;
use crate::{Format, OpenOptions, Problem, Problems, Recognition, WriteOptions};

mod annotation;

use annotation::Gesture;

/// Subjects of the test part, as in OpenDR; the others are for training.
const TEST_SUBJECTS: [&str; 2] = ["Subject4", "Subject5"];
const COLOURS: [&str; 2] = ["rgb", "color"];

/// Gestures in colour and depth: a sample has a colour image, a depth image (16 bits) and the gesture as class.
///
/// HANDS has a folder for each subject; `train` has subjects 1 to 3, `test` 4 and 5. Two gestures at once are a
/// class of their own (`A_AND_B`). Otherwise `rgb/CLASS/` and `depth/CLASS/` have images of the same names.
#[derive(Debug)]
pub struct Hands {
    gestures: Vec<Gesture>,
    classes: Classes,
}

impl Hands {
    fn gesture(&self, index: usize) -> Result<&Gesture> {
        self.gestures.get(index).ok_or_else(|| past_end(index, self.gestures.len()))
    }

    /// Returns the file of the depth image of sample `index`.
    pub fn depth_path(&self, index: usize) -> Option<&Path> {
        self.gestures.get(index).map(|gesture| gesture.depth.as_path())
    }
}

impl Dataset for Hands {}

impl DatasetIterator for Hands {
    fn len(&self) -> usize {
        self.gestures.len()
    }

    fn get(&self, index: usize) -> Result<Sample> {
        let gesture = self.gesture(index)?;
        let colour = opendr_vision::open(&gesture.colour)?;
        let depth = Decoder::default().open_depth(&gesture.depth)?;
        if (colour.width(), colour.height()) != (depth.width(), depth.height()) {
            let (width, height) = (colour.width(), colour.height());
            let message = format!(
                "has {}x{} pixels, its colour image has {width}x{height}",
                depth.width(),
                depth.height()
            );
            return Err(Problem::new(&gesture.depth, message).into());
        }
        Ok(Sample { data: vec![Value::Image(colour), Value::Image(depth)], target: self.target(index)? })
    }

    fn target(&self, index: usize) -> Result<Option<Value>> {
        let name = &self.gesture(index)?.class;
        let class = self.classes.index(name).unwrap_or_default();
        let description = Some(name.as_str().into());
        Ok(Some(Value::Category(Category { description, ..Category::new(class, Some(1.0)) })))
    }

    fn name(&self, index: usize) -> String {
        self.gesture(index).map_or_else(|_| index.to_string(), |gesture| name_of(&gesture.colour))
    }

    fn path(&self, index: usize) -> Option<PathBuf> {
        self.gestures.get(index).map(|gesture| gesture.colour.clone())
    }

    fn classes(&self) -> Classes {
        self.classes.clone()
    }
}

impl Format for Hands {
    const NAME: &'static str = "hands";
    const ALIASES: &'static [&'static str] = &["rgbd", "rgbd_gestures"];
    const ABOUT: &'static str = "HANDS: gestures in colour and depth";
    const LAYOUT: &'static str = "SubjectN/ with SubjectN.txt, SubjectN/ and SubjectN_Depth/; or [PART/]rgb/CLASS/ and depth/CLASS/ with \
                                  images of the same names";
    const TARGETS: &'static [ValueType] = &[ValueType::Category];

    fn recognise(path: &Path) -> Recognition {
        let parts =
            std::iter::once(path.to_owned()).chain(folders_in(path).into_iter().map(|part| path.join(part)));
        match !subjects(path).is_empty() || parts.into_iter().any(|part| colours(&part).is_some()) {
            true => Recognition::Certain,
            false => Recognition::No(
                "SubjectN/SubjectN.txt, or folders rgb/ and depth/ with folders of classes".into(),
            ),
        }
    }

    fn read_index(path: &Path, options: &OpenOptions, problems: &Problems) -> Result<Self> {
        let split = options.split.as_deref();
        let subjects = subjects(path);
        let (gestures, classes) = match subjects.is_empty() {
            false => of_subjects(path, &subjects, split, problems)?,
            true => of_folders(path, split, problems)?,
        };
        if gestures.is_empty() {
            let (path, layout) = (path.display(), Self::LAYOUT);
            return Err(Error::not_found(format!(
                "no gesture of that part in {path}; the layout is {layout}"
            )));
        }
        Ok(Self { gestures, classes })
    }

    /// Writes `rgb/CLASS/` and `depth/CLASS/`, in a folder of the part if one is named.
    fn write(
        dataset: &dyn DatasetIterator,
        path: &Path,
        options: &WriteOptions,
        problems: &Problems,
        progress: &dyn Progress,
    ) -> Result<()> {
        let root = options.split.as_deref().map_or(Ok(path.to_owned()), |part| path_inside(path, part));
        let root = root.map_err(Error::invalid_param)?;
        let classes = dataset.classes();
        write_each(dataset, problems, progress, |index| {
            let sample = dataset.get(index)?;
            let (Some(Value::Image(colour)), Some(Value::Image(depth)), Some(Value::Category(category))) =
                (sample.data.first(), sample.data.get(1), &sample.target)
            else {
                return Err(Error::invalid_input(
                    "the sample needs a colour image, a depth image and a Category",
                ));
            };
            let named = category.description.clone().or_else(|| classes.name(category.class).cloned());
            let class = named.map_or_else(|| category.class.to_string(), |name| name.to_string());
            let place = |kind: &str| path_inside(&root, &format!("{kind}/{class}/{index:06}.png"));
            let (to, depth_to) = (place("rgb"), place("depth"));
            let (to, depth_to) = (to.map_err(Error::invalid_input)?, depth_to.map_err(Error::invalid_input)?);
            write_picture(dataset.path(index).as_deref(), colour, &to, options.link)?;
            std::fs::create_dir_all(depth_to.parent().unwrap_or(&root))?;
            save_depth(depth, depth_to)
        })
    }
}

/// Returns the folders with the label file of a subject.
fn subjects(path: &Path) -> Vec<String> {
    let mut names = folders_in(path);
    names.retain(|name| path.join(name).join(format!("{name}.txt")).is_file());
    names
}

fn of_subjects(
    path: &Path,
    subjects: &[String],
    split: Option<&str>,
    problems: &Problems,
) -> Result<(Vec<Gesture>, Classes)> {
    // Classes are numbered over all subjects, so that they are the same in every part.
    let (mut gestures, mut names) = (Vec::new(), Vec::new());
    for subject in subjects {
        let is_test = TEST_SUBJECTS.contains(&subject.as_str());
        let is_selected = match split {
            None => true,
            Some("train") => !is_test,
            Some("test" | "val") => is_test,
            Some(other) => other == subject,
        };
        let found = annotation::read(path, subject, is_selected, problems)?;
        names.extend(found.iter().map(|gesture| gesture.class.clone()));
        if is_selected {
            gestures.extend(found);
        }
    }
    names.sort_unstable();
    names.dedup();
    Ok((gestures, names.into_iter().collect()))
}

/// Returns the folder of colour images, if there is one of depth images beside it.
fn colours(path: &Path) -> Option<PathBuf> {
    let colour = COLOURS.iter().map(|name| path.join(name)).find(|folder| folder.is_dir())?;
    (path.join("depth").is_dir() && !folders_in(&colour).is_empty()).then_some(colour)
}

fn of_folders(path: &Path, split: Option<&str>, problems: &Problems) -> Result<(Vec<Gesture>, Classes)> {
    let root = match colours(path) {
        Some(_) if split.is_none() => path.to_owned(),
        _ => crate::folder::part_folder(path, split, &["test", "val", "train"])?
            .unwrap_or_else(|| path.to_owned()),
    };
    let Some(colour) = colours(&root) else { return Ok((Vec::new(), Classes::default())) };
    let names = folders_in(&colour);
    let mut gestures = Vec::new();
    for class in &names {
        for name in files_in(&colour.join(class), PICTURES) {
            let stem = name.rsplit_once('.').map_or(name.as_str(), |(stem, _)| stem);
            let depth = root.join("depth").join(class).join(format!("{stem}.png"));
            if depth.is_file() {
                gestures.push(Gesture {
                    colour: colour.join(class).join(&name),
                    depth,
                    class: class.clone(),
                });
            } else {
                problems.report(Problem::new(depth, "is missing beside its colour image; add it"))?;
            }
        }
    }
    Ok((gestures, names.into_iter().collect()))
}

#[cfg(test)]
mod tests;
