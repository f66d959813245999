//! Selection of messages of a recording.

use std::ops::RangeInclusive;

/// Selection of messages and their order. The default is all messages, in order of their log time.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Selection {
    /// Topics to read; `None` for all. Unknown topics are ignored.
    pub topics: Option<Vec<String>>,
    /// Earliest log time, in nanoseconds.
    pub start_ns: Option<i64>,
    /// Latest log time, in nanoseconds.
    pub end_ns: Option<i64>,
    /// Whether to read in the order of the file, with one chunk in memory at a time, instead of in order of time.
    pub in_file_order: bool,
}

impl Selection {
    /// Selects these topics.
    pub fn topics<T: Into<String>>(topics: impl IntoIterator<Item = T>) -> Self {
        Self { topics: Some(topics.into_iter().map(Into::into).collect()), ..Self::default() }
    }

    pub(crate) fn times(&self) -> RangeInclusive<i64> {
        self.start_ns.unwrap_or(i64::MIN)..=self.end_ns.unwrap_or(i64::MAX)
    }
}

/// A selection for one storage: topics are flags of its channels.
#[derive(Debug, Clone)]
pub(crate) struct Filter {
    pub channels: Vec<bool>,
    pub times: RangeInclusive<i64>,
    pub in_file_order: bool,
}

impl Filter {
    pub fn channel(&self, channel: usize) -> bool {
        self.channels.get(channel).copied().unwrap_or(false)
    }

    /// Returns whether the selection overlaps the times from `start` to `end`.
    pub fn span(&self, start: i64, end: i64) -> bool {
        start <= *self.times.end() && *self.times.start() <= end
    }
}
