//! Progress of the stages of a training as that of one training.

use opendr_engine::{Progress, Unit};

/// Counts the steps of earlier stages, too, so that a stop at a given step counts those of all stages.
pub(super) struct StageProgress<'a> {
    pub inner: &'a dyn Progress,
    /// Name of the stage.
    pub name: &'a str,
    /// Number of steps of the stages before.
    pub steps: u64,
}

impl Progress for StageProgress<'_> {
    fn begin(&self, what: &str, total: Option<u64>, unit: Unit) {
        if unit != Unit::Steps {
            return self.inner.begin(what, total, unit);
        }
        let what = format!("{what} {}", self.name);
        self.inner.begin(&what, total.map(|total| self.steps + total), unit);
        self.inner.advance_resumed(self.steps);
    }

    fn advance(&self, amount: u64) {
        self.inner.advance(amount);
    }

    fn advance_resumed(&self, amount: u64) {
        self.inner.advance_resumed(amount);
    }

    fn end(&self) {
        self.inner.end();
    }

    fn status(&self, text: &str) {
        self.inner.status(text);
    }

    fn note(&self, line: &str) {
        self.inner.note(line);
    }

    fn stopped(&self) -> bool {
        self.inner.stopped()
    }
}
