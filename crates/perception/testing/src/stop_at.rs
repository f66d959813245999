//! A progress that requests a stop.

use std::sync::atomic::{AtomicU64, Ordering};

use opendr_engine::{Progress, Unit};

/// Requests a stop after a number of steps of a training, as the tuner does.
pub struct StopAt {
    steps: u64,
    done: AtomicU64,
}

impl StopAt {
    /// Requests a stop after this number of steps.
    pub fn new(steps: u64) -> Self {
        Self { steps, done: AtomicU64::new(0) }
    }
}

impl Progress for StopAt {
    fn begin(&self, _: &str, _: Option<u64>, unit: Unit) {
        assert_eq!(unit, Unit::Steps);
        self.done.store(0, Ordering::Relaxed);
    }

    fn advance(&self, amount: u64) {
        self.done.fetch_add(amount, Ordering::Relaxed);
    }

    fn end(&self) {}

    fn stopped(&self) -> bool {
        self.done.load(Ordering::Relaxed) >= self.steps
    }
}
