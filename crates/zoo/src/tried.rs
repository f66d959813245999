//! What was tried and why it failed.

use opendr_engine::{Error, ErrorKind};

use crate::item::Item;

/// Collects the failures of an item's sources.
#[derive(Debug, Default)]
pub(crate) struct Tried(Vec<(String, Error)>);

impl Tried {
    pub(crate) fn add(&mut self, place: impl Into<String>, error: Error) {
        self.0.push((place.into(), error));
    }

    /// One error that tells them all. Its kind is the gravest: damage, then the network, then that nothing was found.
    pub(crate) fn error(&self, item: &Item<'_>) -> Error {
        let has = |kind| self.0.iter().any(|(_, error)| error.kind() == kind);
        let kinds = [ErrorKind::Integrity, ErrorKind::Io, ErrorKind::Network, ErrorKind::Unsupported];
        let kind = kinds.into_iter().find(|kind| has(*kind)).unwrap_or(ErrorKind::NotFound);
        let mut text = format!("{item} could not be got; tried:");
        for (place, error) in &self.0 {
            let error = error.to_string();
            let place = if error.starts_with(place) { String::new() } else { format!("{place}: ") };
            text.push_str(&format!("\n  {place}{error}"));
        }
        text.push_str(
            "\nset OPENDR_MODEL_REPOSITORY to a folder or address that has it, or see to one of these sources",
        );
        Error::new(kind, text)
    }
}
