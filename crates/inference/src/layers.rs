//! Profiles of the layers of all sessions of a thread.
//!
//! Call [`start`], run the learner on the same thread, and [`take`] the profiles. Nothing is profiled otherwise. Engines without
//! profiles (ONNX Runtime) contribute none.

use std::cell::RefCell;

pub use opendr_executor::LayerProfile;
pub use opendr_kernels::{LayerCost, Limits};

/// Profile of a run of a session.
#[derive(Debug, Clone)]
pub struct SessionProfile {
    /// Number of the session; sessions are numbered in the order in which the process opens them.
    pub session: usize,
    /// Steps of the run, in their order.
    pub layers: Vec<LayerProfile>,
}

thread_local! {
    static PROFILES: RefCell<Option<Vec<SessionProfile>>> = const { RefCell::new(None) };
}

/// Starts profiling on this thread; earlier profiles are dropped.
pub fn start() {
    PROFILES.set(Some(Vec::new()));
}

/// Stops profiling on this thread and returns the profiles since it started, in the order in which the runs ended.
pub fn take() -> Vec<SessionProfile> {
    PROFILES.take().unwrap_or_default()
}

/// Measures the arithmetic and the bandwidth of the machine with as many threads as sessions of the built-in runtime use, which takes
/// some tenths of a second.
pub fn limits(threads: usize) -> Limits {
    Limits::measure(&crate::builtin::compute(threads))
}

/// Returns whether this thread profiles.
pub(crate) fn is_on() -> bool {
    PROFILES.with_borrow(Option::is_some)
}

/// Adds a run.
pub(crate) fn add(session: usize, layers: Vec<LayerProfile>) {
    PROFILES.with_borrow_mut(|profiles| {
        if let Some(profiles) = profiles {
            profiles.push(SessionProfile { session, layers });
        }
    });
}
