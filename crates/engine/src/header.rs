//! Time stamp and coordinate frame of a datum.

use std::sync::Arc;

use serde::{Deserialize, Serialize};

/// Time stamp and coordinate frame of a datum. Every target computed from an input has the header of that input.
///
/// Cloning copies no text and allocates nothing.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Header {
    /// Time stamp: nanoseconds since the Unix epoch, or since the start of a recording; `None` when unknown.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stamp_ns: Option<i64>,
    /// Coordinate frame (ROS's `frame_id`, e.g. `"camera_link"`); `None` when unknown.
    #[serde(default, skip_serializing_if = "Option::is_none", with = "optional_text")]
    pub frame_id: Option<Arc<str>>,
}

impl Header {
    /// Creates a header with a time stamp in nanoseconds and a frame id.
    pub fn new(stamp_ns: i64, frame_id: impl Into<Arc<str>>) -> Self {
        Self { stamp_ns: Some(stamp_ns), frame_id: Some(frame_id.into()) }
    }
}

/// Serde functions for shared, optional text.
pub(crate) mod optional_text {
    use super::Arc;
    use serde::{Deserialize, Deserializer, Serializer};

    pub(crate) fn serialize<S: Serializer>(
        value: &Option<Arc<str>>,
        serializer: S,
    ) -> Result<S::Ok, S::Error> {
        match value {
            Some(text) => serializer.serialize_str(text),
            None => serializer.serialize_none(),
        }
    }

    pub(crate) fn deserialize<'de, D: Deserializer<'de>>(
        deserializer: D,
    ) -> Result<Option<Arc<str>>, D::Error> {
        Ok(Option::<String>::deserialize(deserializer)?.map(Arc::from))
    }
}
