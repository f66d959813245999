//! Errors of the sources of an item.

use opendr_engine::{Error, ErrorKind};

use crate::item::Item;

/// Errors of an item's sources.
#[derive(Debug, Default)]
pub(crate) struct SourceErrors(Vec<(String, Error)>);

impl SourceErrors {
    pub(crate) fn add(&mut self, place: impl Into<String>, error: Error) {
        self.0.push((place.into(), error));
    }

    /// Returns one error that lists all. Its kind is the most severe: `Integrity`, then `Network`, then `NotFound`.
    pub(crate) fn error(&self, item: &Item<'_>) -> Error {
        let has = |kind| self.0.iter().any(|(_, error)| error.kind() == kind);
        let kinds = [ErrorKind::Integrity, ErrorKind::Io, ErrorKind::Network, ErrorKind::Unsupported];
        let kind = kinds.into_iter().find(|kind| has(*kind)).unwrap_or(ErrorKind::NotFound);
        let mut text = format!("{item} could not be downloaded; tried:");
        for (place, error) in &self.0 {
            let error = error.to_string();
            let place = if error.starts_with(place) { String::new() } else { format!("{place}: ") };
            text.push_str(&format!("\n  {place}{error}"));
        }
        text.push_str(
            "\nset OPENDR_MODEL_REPOSITORY to a folder or address that contains it, or make one of these sources available",
        );
        Error::new(kind, text)
    }
}
