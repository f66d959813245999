//! Reports as JSON.

use opendr::Error;

/// Returns the JSON of a report.
pub fn json_of(report: &impl serde::Serialize) -> opendr::Result<String> {
    serde_json::to_string(report)
        .map_err(|error| Error::internal("the report cannot be written as JSON").with_source(error))
}
