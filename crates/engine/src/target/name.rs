//! The class of an object: an index or a label.

use std::fmt;
use std::sync::Arc;

use serde::{Deserialize, Serialize};

/// The class of an object: the index that a network predicts, or the label in a data set (OpenDR's `name`).
#[derive(Debug, Clone, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Name {
    /// Class index.
    Index(i64),
    /// Class label.
    #[serde(with = "label")]
    Label(Arc<str>),
}

impl Default for Name {
    fn default() -> Self {
        Self::Index(0)
    }
}

impl fmt::Display for Name {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Index(index) => write!(f, "{index}"),
            Self::Label(label) => f.write_str(label),
        }
    }
}

impl From<i64> for Name {
    fn from(index: i64) -> Self {
        Self::Index(index)
    }
}

impl From<&str> for Name {
    fn from(label: &str) -> Self {
        Self::Label(label.into())
    }
}

mod label {
    use super::Arc;
    use serde::{Deserialize, Deserializer, Serializer};

    pub fn serialize<S: Serializer>(label: &Arc<str>, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(label)
    }

    pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Arc<str>, D::Error> {
        String::deserialize(deserializer).map(Arc::from)
    }
}
