//! Which messages of a recording are wanted.

use std::ops::RangeInclusive;

/// Which messages are wanted and in which order; the default is all, in order of their log time.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Selection {
    /// Only these topics; `None` is all of them. Names that the recording does not have are no error.
    pub topics: Option<Vec<String>>,
    /// Only messages recorded at this time or later, nanoseconds.
    pub start_ns: Option<i64>,
    /// Only messages recorded at this time or earlier, nanoseconds.
    pub end_ns: Option<i64>,
    /// In the order of the file: chunks are never held beside each other, whatever their times.
    pub in_file_order: bool,
}

impl Selection {
    /// Only these topics.
    pub fn topics<T: Into<String>>(topics: impl IntoIterator<Item = T>) -> Self {
        Self { topics: Some(topics.into_iter().map(Into::into).collect()), ..Self::default() }
    }

    pub(crate) fn times(&self) -> RangeInclusive<i64> {
        self.start_ns.unwrap_or(i64::MIN)..=self.end_ns.unwrap_or(i64::MAX)
    }
}

/// A selection with its topics as channels of one storage.
#[derive(Debug, Clone)]
pub(crate) struct Wanted {
    pub channels: Vec<bool>,
    pub times: RangeInclusive<i64>,
    pub in_file_order: bool,
}

impl Wanted {
    pub fn channel(&self, channel: usize) -> bool {
        self.channels.get(channel).copied().unwrap_or(false)
    }

    /// Whether something of these times can be wanted.
    pub fn span(&self, start: i64, end: i64) -> bool {
        start <= *self.times.end() && *self.times.start() <= end
    }
}
