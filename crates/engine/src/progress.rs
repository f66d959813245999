//! Progress of long operations.

/// Unit of the amounts of a [`Progress`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Unit {
    /// Bytes of a download or file.
    Bytes,
    /// Images, frames, records.
    Items,
    /// Optimiser or environment steps.
    Steps,
}

/// Receives the progress of one operation at a time; surfaces show it as a progress bar.
///
/// Library code never prints: functions that take more than about two seconds take a `&dyn Progress`.
pub trait Progress: Send + Sync {
    /// Starts an operation: `what` in a few words, `total` if it is known.
    fn begin(&self, what: &str, total: Option<u64>, unit: Unit);
    /// Adds `amount` to the work done.
    fn advance(&self, amount: u64);
    /// Adds `amount` that was done before the operation started, by a run that it resumes: it counts for the position, and not for
    /// the speed and the time left.
    fn advance_resumed(&self, amount: u64) {
        self.advance(amount);
    }
    /// Ends the operation, complete or not.
    fn end(&self);
    /// Sets a short status, e.g. "loss 0.31, 42 images/s"; surfaces show it beside the bar until the next one.
    fn status(&self, _text: &str) {}
    /// Reports a line of text, such as a warning.
    fn note(&self, _line: &str) {}
    /// Returns whether the user requested a stop (Ctrl-C). Long operations check it between steps and return early.
    fn stopped(&self) -> bool {
        false
    }
}

/// A [`Progress`] that discards everything.
#[derive(Debug, Clone, Copy, Default)]
pub struct Silent;

impl Progress for Silent {
    fn begin(&self, _what: &str, _total: Option<u64>, _unit: Unit) {}
    fn advance(&self, _amount: u64) {}
    fn end(&self) {}
}
