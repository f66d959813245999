//! Snapshots as text, which Python can keep and copy.

use opendr::environment::Snapshot;
use opendr::{Error, Result};

/// The longest snapshot that is read, in bytes.
const MAX_SNAPSHOT: usize = 1 << 28;

pub fn text_from_snapshot(snapshot: &Snapshot) -> Result<String> {
    serde_json::to_string(snapshot)
        .map_err(|error| Error::internal("a snapshot has no JSON form").with_source(error))
}

pub fn snapshot_from_text(text: &str) -> Result<Snapshot> {
    if text.len() > MAX_SNAPSHOT {
        return Err(Error::format(format!(
            "a snapshot of {} bytes; it has at most {MAX_SNAPSHOT}",
            text.len()
        )));
    }
    serde_json::from_str(text).map_err(|error| {
        Error::format("this is no snapshot; give what snapshot() returned").with_source(error)
    })
}
