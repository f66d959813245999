//! The part of an item that comes from a recording.

#[cfg(not(feature = "ros"))]
use std::convert::Infallible;
#[cfg(feature = "ros")]
use std::sync::Arc;

use opendr::Value;
#[cfg(feature = "ros")]
use opendr::bags::{RecordedMessage, Recording};

/// Values and messages of a recording beside the value of the first port; a build without the feature `ros` has none.
pub struct RecordedSet {
    /// Values of the further ports, by name.
    pub further: Vec<(&'static str, Value)>,
    /// Log time of the first port's message, in nanoseconds.
    #[cfg(feature = "ros")]
    pub log_time_ns: i64,
    /// Whether it is the last set of its recording.
    pub is_last: bool,
    /// Messages from which the values were read.
    #[cfg(feature = "ros")]
    pub messages: Vec<RecordedMessage>,
    /// Recording of the messages.
    #[cfg(feature = "ros")]
    pub recording: Arc<Recording>,
    #[cfg(not(feature = "ros"))]
    _never: Infallible,
}
