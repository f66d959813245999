//! Items of `opendr infer`: the inputs of one call of the learner.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use opendr::vision::Frame;
use opendr::{Error, Value, ValueRef};

use crate::recorded_set::RecordedSet;

/// Input of one call.
pub struct Item {
    /// Value of the first port.
    pub datum: Datum,
    /// Values of further ports that were read from files, by port name.
    pub from_files: Vec<(&'static str, Value)>,
    /// Further values and messages of a recording.
    pub recorded: Option<Box<RecordedSet>>,
}

/// Value of the first port, with its origin.
pub enum Datum {
    Frame(Frame),
    Value {
        value: Box<Value>,
        path: Arc<Path>,
        /// Index among all values of all inputs.
        index: u64,
        /// Index within its file.
        number: u64,
        /// Whether the value belongs to a stream, such as a message of a recording.
        is_of_stream: bool,
    },
}

/// The next item, or an error with its file, if there is one.
pub type Next = Result<Item, (Option<PathBuf>, Error)>;

impl Item {
    /// Returns the file or device of the item.
    pub fn path(&self) -> &Arc<Path> {
        match &self.datum {
            Datum::Frame(frame) => &frame.path,
            Datum::Value { path, .. } => path,
        }
    }

    /// Returns the value of the learner's first port.
    pub fn value(&self) -> ValueRef<'_> {
        match &self.datum {
            Datum::Frame(frame) => ValueRef::Image(&frame.image),
            Datum::Value { value, .. } => value.as_value_ref(),
        }
    }

    /// Returns the values of further ports in a recording, by port name.
    pub fn further(&self) -> &[(&'static str, Value)] {
        self.recorded.as_deref().map_or(&[], |recorded| &recorded.further)
    }

    /// Returns the index of the item among all inputs, from 0.
    pub fn index(&self) -> u64 {
        match &self.datum {
            Datum::Frame(frame) => frame.item_index,
            Datum::Value { index, .. } => *index,
        }
    }

    /// Returns the index of the item within its file, from 0.
    pub fn number(&self) -> u64 {
        match &self.datum {
            Datum::Frame(frame) => frame.frame_index,
            Datum::Value { number, .. } => *number,
        }
    }

    /// Returns the stamp in nanoseconds, if it is known.
    #[cfg(feature = "ros")]
    pub fn stamp_ns(&self) -> Option<i64> {
        match &self.datum {
            Datum::Frame(frame) => frame.image.header.stamp_ns,
            Datum::Value { value, .. } => value.header().stamp_ns,
        }
    }

    /// Returns whether the item is a frame of a video, a camera or a recording.
    pub fn is_of_stream(&self) -> bool {
        match &self.datum {
            Datum::Frame(frame) => frame.video.is_some(),
            Datum::Value { is_of_stream, .. } => *is_of_stream,
        }
    }
}
