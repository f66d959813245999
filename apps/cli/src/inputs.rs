//! What `opendr infer` is given: frames for a learner of pictures, else a file for each call.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use opendr::datasets::{open_value, value_files};
use opendr::vision::{Frame, Source, SourceOptions};
use opendr::{Error, Result, Value, ValueRef, ValueType};

use crate::report::Report;

/// Everything that one call of the command reads, in order.
pub enum Inputs {
    /// Pictures, videos, cameras.
    Frames(Source),
    /// Sounds, series, point clouds: a value a file.
    Files {
        kind: ValueType,
        paths: Vec<PathBuf>,
        /// How many were given out.
        given: usize,
    },
}

/// What goes into the first port in one call.
pub enum Item {
    Frame(Frame),
    File { value: Box<Value>, path: Arc<Path>, index: u64 },
}

impl Inputs {
    /// Opens all inputs for a port of the type `kind`. Those that cannot be opened are reported and left out, unless
    /// there is only one.
    ///
    /// # Errors
    /// `NotFound` when nothing is left, else what kept the only input from being opened, or the report from being
    /// written.
    pub fn open(kind: ValueType, inputs: &[&PathBuf], report: &mut Report<'_>) -> Result<Self> {
        if kind == ValueType::Image {
            return frames(inputs, report).map(Self::Frames);
        }
        let mut paths = Vec::new();
        for input in inputs {
            match value_files(kind, input) {
                Ok(files) => paths.extend(files),
                Err(error) if inputs.len() == 1 => return Err(error),
                Err(error) => report.failure(Some(input), &error)?,
            }
        }
        if paths.is_empty() {
            return Err(Error::not_found("none of the inputs can be read; the reasons are above"));
        }
        Ok(Self::Files { kind, paths, given: 0 })
    }

    /// How many items there will be, as far as that is known.
    pub fn len_hint(&self) -> Option<u64> {
        match self {
            Self::Frames(source) => source.len_hint(),
            Self::Files { paths, given, .. } => Some((paths.len() - given) as u64),
        }
    }

    /// Whether items have nothing to do with each other, as frames of a video have.
    pub fn are_separate(&self) -> bool {
        match self {
            Self::Frames(source) => source.is_pictures(),
            Self::Files { .. } => true,
        }
    }
}

/// The next item, or why it could not be read, with its file where there is one.
impl Iterator for Inputs {
    type Item = std::result::Result<Item, (Option<PathBuf>, Error)>;

    fn next(&mut self) -> Option<Self::Item> {
        match self {
            Self::Frames(source) => {
                let frame = source.next()?;
                Some(frame.map(Item::Frame).map_err(|error| (source.last_path().map(Path::to_owned), error)))
            }
            Self::Files { kind, paths, given } => {
                let path = paths.get(*given)?;
                let index = *given as u64;
                *given += 1;
                let item = open_value(*kind, path).map(|value| Item::File {
                    value: value.into(),
                    path: path.as_path().into(),
                    index,
                });
                Some(item.map_err(|error| (Some(path.clone()), error)))
            }
        }
    }
}

impl Item {
    /// The file or device it came from.
    pub fn path(&self) -> &Arc<Path> {
        match self {
            Self::Frame(frame) => &frame.path,
            Self::File { path, .. } => path,
        }
    }

    /// What is given to the learner.
    pub fn value(&self) -> ValueRef<'_> {
        match self {
            Self::Frame(frame) => ValueRef::Image(&frame.image),
            Self::File { value, .. } => value.as_value_ref(),
        }
    }

    /// Its number among all that was read, from 0.
    pub fn index(&self) -> u64 {
        match self {
            Self::Frame(frame) => frame.index,
            Self::File { index, .. } => *index,
        }
    }

    /// Its number within its file, from 0.
    pub fn number(&self) -> u64 {
        match self {
            Self::Frame(frame) => frame.number,
            Self::File { .. } => 0,
        }
    }

    /// Whether it is a frame of a video or camera.
    pub fn is_of_video(&self) -> bool {
        matches!(self, Self::Frame(frame) if frame.video.is_some())
    }
}

fn frames(inputs: &[&PathBuf], report: &mut Report<'_>) -> Result<Source> {
    let all = Source::open_all(inputs, SourceOptions::default());
    if all.is_ok() || inputs.len() == 1 {
        return all;
    }
    let mut good = Vec::new();
    for input in inputs {
        match Source::open(input) {
            Ok(_) => good.push(*input),
            Err(error) => report.failure(Some(input), &error)?,
        }
    }
    Source::open_all(good, SourceOptions::default())
}
