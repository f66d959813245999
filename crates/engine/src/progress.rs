//! How long work tells what it is doing.

/// What the numbers of a [`Progress`] count.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Unit {
    /// Bytes of a download or file.
    Bytes,
    /// Pictures, frames, records.
    Items,
    /// Optimiser or environment steps.
    Steps,
}

/// Receives the progress of one piece of work at a time; surfaces draw a bar with it.
///
/// Library code never prints: whatever takes over two seconds takes a `&dyn Progress`.
pub trait Progress: Send + Sync {
    /// Work begins: `what` in a few words, `total` when it is known.
    fn begin(&self, what: &str, total: Option<u64>, unit: Unit);
    /// `amount` more is done.
    fn advance(&self, amount: u64);
    /// The work is over, done or not.
    fn end(&self);
    /// How the work goes right now, e.g. "loss 0.31, 42 images/s"; shown beside the bar until the next one.
    fn status(&self, _text: &str) {}
    /// A line worth reading in between.
    fn note(&self, _line: &str) {}
    /// Whether the user asked to stop (Ctrl-C); long work asks it between pieces and returns early.
    fn stopped(&self) -> bool {
        false
    }
}

/// Tells nobody.
#[derive(Debug, Clone, Copy, Default)]
pub struct Silent;

impl Progress for Silent {
    fn begin(&self, _what: &str, _total: Option<u64>, _unit: Unit) {}
    fn advance(&self, _amount: u64) {}
    fn end(&self) {}
}
