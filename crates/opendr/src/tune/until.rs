//! Progress display that stops a training at a given step.

use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

use opendr_engine::{Progress, Unit};

/// Requests a stop after a number of steps, or when the user does.
pub(super) struct Until<'a> {
    inner: &'a dyn Progress,
    steps: u64,
    done: AtomicU64,
    counts: AtomicBool,
}

impl<'a> Until<'a> {
    pub(super) fn new(inner: &'a dyn Progress, steps: u64) -> Self {
        Self { inner, steps, done: AtomicU64::new(0), counts: AtomicBool::new(false) }
    }
}

impl Progress for Until<'_> {
    fn begin(&self, _: &str, _: Option<u64>, unit: Unit) {
        self.counts.store(unit == Unit::Steps, Ordering::Relaxed);
        if unit == Unit::Steps {
            self.done.store(0, Ordering::Relaxed);
        }
    }

    fn advance(&self, amount: u64) {
        if self.counts.load(Ordering::Relaxed) {
            self.done.fetch_add(amount, Ordering::Relaxed);
        }
    }

    fn end(&self) {}

    fn stopped(&self) -> bool {
        self.done.load(Ordering::Relaxed) >= self.steps || self.inner.stopped()
    }
}
