//! Snapshots as text, which Python can store and copy.

use opendr::environment::Snapshot;
use opendr::{Error, Result};

/// Maximum size of a snapshot that is read, in bytes.
const MAX_SNAPSHOT: usize = 1 << 28;

pub fn text_from_snapshot(snapshot: &Snapshot) -> Result<String> {
    serde_json::to_string(snapshot)
        .map_err(|error| Error::internal("the snapshot cannot be written as JSON").with_source(error))
}

pub fn snapshot_from_text(text: &str) -> Result<Snapshot> {
    if text.len() > MAX_SNAPSHOT {
        return Err(Error::format(format!(
            "the snapshot has {} bytes; the maximum is {MAX_SNAPSHOT}",
            text.len()
        )));
    }
    serde_json::from_str(text).map_err(|error| {
        Error::format("the text is not a snapshot; give the text that snapshot() returned").with_source(error)
    })
}
