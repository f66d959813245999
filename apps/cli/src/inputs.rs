//! Inputs of `opendr infer`: frames for a learner of images, one file per call for other learners, or recordings.

use std::path::{Path, PathBuf};

use clap::ArgMatches;
use opendr::datasets::{open_value, value_files};
use opendr::learner::Entry;
use opendr::vision::{Source, SourceOptions};
use opendr::{Error, Result, ValueType};

use crate::item::{Datum, Item, Next};
use crate::recordings::Recordings;
use crate::report::Report;

/// All inputs of one command, in order.
pub enum Inputs {
    /// Images, videos, cameras.
    Frames(Source),
    /// Audio, time series, point clouds: one value per file.
    Files {
        kind: ValueType,
        paths: Vec<PathBuf>,
        /// Number of files already read.
        given: usize,
    },
    /// ROS recordings.
    Recordings(Recordings),
}

impl Inputs {
    /// Opens all inputs for the ports of a learner. Inputs that cannot be opened are reported and skipped, unless there is only one.
    ///
    /// # Errors
    /// `NotFound` when no input can be opened; the error of the only input, or of writing the report.
    pub fn open(
        entry: &'static Entry,
        inputs: &[&PathBuf],
        matches: &ArgMatches,
        report: &mut Report<'_>,
    ) -> Result<Self> {
        if let Some(recordings) = Recordings::open(entry, inputs, matches, report)? {
            return Ok(Self::Recordings(recordings));
        }
        let kind = entry.ports.first().map_or(ValueType::Image, |port| port.value_type);
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
            return Err(Error::not_found("none of the inputs can be read; the errors are above"));
        }
        Ok(Self::Files { kind, paths, given: 0 })
    }

    /// Returns the number of remaining items, if it is known.
    pub fn len_hint(&self) -> Option<u64> {
        match self {
            Self::Frames(source) => source.len_hint(),
            Self::Files { paths, given, .. } => Some((paths.len() - given) as u64),
            Self::Recordings(recordings) => Some(recordings.len_hint()),
        }
    }

    /// Returns whether the items are independent, unlike frames of a video.
    pub fn are_independent(&self) -> bool {
        match self {
            Self::Frames(source) => source.is_images(),
            Self::Files { .. } => true,
            Self::Recordings(_) => false,
        }
    }
}

impl Iterator for Inputs {
    type Item = Next;

    fn next(&mut self) -> Option<Next> {
        let item = |datum| Item { datum, from_files: Vec::new(), recorded: None };
        match self {
            Self::Frames(source) => {
                let frame = source.next()?;
                let frame = frame.map(|frame| item(Datum::Frame(frame)));
                Some(frame.map_err(|error| (source.current_path().map(Path::to_owned), error)))
            }
            Self::Files { kind, paths, given } => {
                let path = paths.get(*given)?;
                let index = *given as u64;
                *given += 1;
                let value = open_value(*kind, path).map(|value| {
                    let (value, path) = (Box::new(value), path.as_path().into());
                    item(Datum::Value { value, path, index, number: 0, is_of_stream: false })
                });
                Some(value.map_err(|error| (Some(path.clone()), error)))
            }
            Self::Recordings(recordings) => recordings.next(),
        }
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
