//! Inputs of the learners, item by item.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use opendr::learner::{Entry, Outputs, Ports};
use opendr::viewer::Viewer;
use opendr::{Error, Result};

use crate::item::{Item, Next};
use crate::port_file::PortFile;
use crate::timings::Timings;

/// Processing of the items.
pub(super) struct Job {
    pub(super) entry: &'static Entry,
    pub(super) port: &'static str,
    pub(super) further: Vec<PortFile>,
    pub(super) sequence: bool,
    /// Maximum number of items.
    pub(super) limit: u64,
    pub(super) viewer: Option<Viewer>,
}

/// Video of the last processed frame; for an image sequence, its folder.
pub(super) type Stream = Option<Arc<Path>>;

/// An item with its outputs (several for a chunk of a stream), or an error with its input.
pub(super) type InferenceResult =
    std::result::Result<(Item, Vec<Outputs>, Timings), (Option<PathBuf>, Error)>;

/// Adds the file of `item` to an error.
pub(super) fn of_item(item: &Item, error: Error) -> (Option<PathBuf>, Error) {
    let path = item.path();
    (Some(path.to_path_buf()), error.context(path.display().to_string()))
}

impl Job {
    /// Returns the values of the ports for an item.
    pub(super) fn ports<'a>(&'a self, item: &'a Item, begins: bool) -> Result<Ports<'a>> {
        let mut ports = Ports::default().with(self.port, item.value());
        for (name, value) in &item.from_files {
            if begins || !self.is_init(name) {
                ports = ports.with(name, value);
            }
        }
        for (name, value) in item.further() {
            ports = ports.with(name, value);
        }
        Ok(ports)
    }

    /// Updates `last` with the item's stream and returns whether a new stream begins. Each video and each recording is a stream, and
    /// so is each other file unless `--sequence` is set; an init port in the middle of a recording begins a new stream too.
    pub(super) fn follow(&self, last: &mut Stream, item: &Item) -> bool {
        let stream = match (item.is_of_stream(), self.sequence) {
            (true, _) => Some(item.path().clone()),
            (false, true) => item.path().parent().map(Arc::from),
            (false, false) => None,
        };
        let is_begun = item.further().iter().any(|(name, _)| self.is_init(name));
        let begins = is_begun || stream.is_none() || stream != *last;
        *last = stream;
        begins
    }

    /// Adds the values of the further ports' files to an item.
    pub(super) fn with_files(&self, mut item: Item) -> Next {
        for file in &self.further {
            match file.value(item.index()) {
                Ok(value) => item.from_files.push((file.name(), value)),
                // An init port is used only where a stream begins.
                Err(_) if self.is_init(file.name()) => {}
                Err(error) => return Err((Some(item.path().to_path_buf()), error)),
            }
        }
        Ok(item)
    }

    fn is_init(&self, name: &str) -> bool {
        self.entry.ports.iter().any(|port| port.name == name && port.init)
    }
}
