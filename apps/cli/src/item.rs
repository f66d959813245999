//! Items of `opendr infer`: the inputs of one call of the learner.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use opendr::vision::Frame;
use opendr::{Error, Value, ValueRef};

use crate::recorded_set::RecordedSet;

/// What one call is given.
pub struct Item {
    /// What goes into the first port.
    pub datum: Datum,
    /// What files have for further ports, by their names.
    pub from_files: Vec<(&'static str, Value)>,
    /// What a recording has besides.
    pub recorded: Option<Box<RecordedSet>>,
}

/// What goes into the first port in one call.
pub enum Datum {
    Frame(Frame),
    Value {
        value: Box<Value>,
        path: Arc<Path>,
        /// Among all that is read.
        index: u64,
        /// Within its file.
        number: u64,
        /// Whether it is a piece of a recording, not a file of its own.
        is_of_stream: bool,
    },
}

/// The next item, or why it could not be read, with its file where there is one.
pub type Next = std::result::Result<Item, (Option<PathBuf>, Error)>;

impl Item {
    /// The file or device it came from.
    pub fn path(&self) -> &Arc<Path> {
        match &self.datum {
            Datum::Frame(frame) => &frame.path,
            Datum::Value { path, .. } => path,
        }
    }

    /// What is given to the learner's first port.
    pub fn value(&self) -> ValueRef<'_> {
        match &self.datum {
            Datum::Frame(frame) => ValueRef::Image(&frame.image),
            Datum::Value { value, .. } => value.as_value_ref(),
        }
    }

    /// What a recording has for further ports, by their names.
    pub fn further(&self) -> &[(&'static str, Value)] {
        self.recorded.as_deref().map_or(&[], |recorded| &recorded.further)
    }

    /// Its number among all that was read, from 0.
    pub fn index(&self) -> u64 {
        match &self.datum {
            Datum::Frame(frame) => frame.index,
            Datum::Value { index, .. } => *index,
        }
    }

    /// Its number within its file, from 0.
    pub fn number(&self) -> u64 {
        match &self.datum {
            Datum::Frame(frame) => frame.number,
            Datum::Value { number, .. } => *number,
        }
    }

    /// When it was taken, where that is known, nanoseconds.
    #[cfg(feature = "ros")]
    pub fn stamp_ns(&self) -> Option<i64> {
        match &self.datum {
            Datum::Frame(frame) => frame.image.header.stamp_ns,
            Datum::Value { value, .. } => value.header().stamp_ns,
        }
    }

    /// Whether it is a frame of a video or camera, or of a recording.
    pub fn is_of_stream(&self) -> bool {
        match &self.datum {
            Datum::Frame(frame) => frame.video.is_some(),
            Datum::Value { is_of_stream, .. } => *is_of_stream,
        }
    }
}
