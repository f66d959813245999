//! Progress of long calls, reported to the caller.

use std::ffi::{CString, c_char, c_void};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};

use opendr::{Progress, Unit};

/// Callback for the progress of a long call. context is the pointer given with the callback, what a description of the work,
/// done and total the progress (total is 0 when unknown), status a text such as "loss 0.31, 42 images/s", or "". Returns
/// whether to continue. It is called by one thread at a time, not always the same one, and must not use the running learner.
pub type opendr_progress = Option<
    unsafe extern "C" fn(
        context: *mut c_void,
        what: *const c_char,
        done: u64,
        total: u64,
        status: *const c_char,
    ) -> bool,
>;

/// The last reported progress.
#[derive(Default)]
struct Report {
    what: CString,
    status: CString,
    done: u64,
    total: u64,
}

/// The caller's callback as a [`Progress`] of the toolkit.
pub(crate) struct Listener {
    call: opendr_progress,
    context: *mut c_void,
    report: Mutex<Report>,
    stopped: AtomicBool,
}

// SAFETY: the context is only handed to the caller's function, which the caller promises may be called by any thread, and
// is called by one at a time.
unsafe impl Send for Listener {}
// SAFETY: as above; everything else is behind a mutex or atomic.
unsafe impl Sync for Listener {}

impl Listener {
    /// # Safety
    /// `call` may be called with `context` from any thread as long as the listener lives.
    pub(crate) unsafe fn new(call: opendr_progress, context: *mut c_void) -> Self {
        Self { call, context, report: Mutex::default(), stopped: AtomicBool::new(false) }
    }

    /// Changes the report and calls the callback with it.
    fn update(&self, change: impl FnOnce(&mut Report)) {
        let Some(call) = self.call else { return };
        let mut report = self.report.lock().unwrap_or_else(PoisonError::into_inner);
        change(&mut report);
        let Report { what, status, done, total } = &*report;
        // SAFETY: as `new` was promised; the texts are valid until the call returns.
        if !unsafe { call(self.context, what.as_ptr(), *done, *total, status.as_ptr()) } {
            self.stopped.store(true, Ordering::Relaxed);
        }
    }
}

impl Progress for Listener {
    fn begin(&self, what: &str, total: Option<u64>, _unit: Unit) {
        self.update(|report| {
            let what = CString::new(what).unwrap_or_default();
            *report = Report { what, total: total.unwrap_or(0), ..Report::default() };
        });
    }

    fn advance(&self, amount: u64) {
        self.update(|report| report.done += amount);
    }

    fn end(&self) {}

    fn status(&self, text: &str) {
        self.update(|report| report.status = CString::new(text).unwrap_or_default());
    }

    fn stopped(&self) -> bool {
        self.stopped.load(Ordering::Relaxed)
    }
}
