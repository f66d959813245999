//! How long work goes, told to the caller.

use std::ffi::{CString, c_char, c_void};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};

use opendr::{Progress, Unit};

/// Hears how long work goes: context is what was handed in with it, what the work in words, done of total (0 when it is not
/// known) what is done, status how it goes right now ("loss 0.31, 42 images/s", "" when there is nothing to say). It answers
/// whether to go on. It is called by one thread at a time, not always the same one, and must not use the learner that works.
pub type opendr_progress = Option<
    unsafe extern "C" fn(
        context: *mut c_void,
        what: *const c_char,
        done: u64,
        total: u64,
        status: *const c_char,
    ) -> bool,
>;

/// What the caller was told last.
#[derive(Default)]
struct Told {
    what: CString,
    status: CString,
    done: u64,
    total: u64,
}

/// The caller's function as the toolkit's progress.
pub(crate) struct Listener {
    call: opendr_progress,
    context: *mut c_void,
    told: Mutex<Told>,
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
        Self { call, context, told: Mutex::default(), stopped: AtomicBool::new(false) }
    }

    /// Changes what is told, and tells it.
    fn tell(&self, change: impl FnOnce(&mut Told)) {
        let Some(call) = self.call else { return };
        let mut told = self.told.lock().unwrap_or_else(PoisonError::into_inner);
        change(&mut told);
        let Told { what, status, done, total } = &*told;
        // SAFETY: as `new` was promised; the texts live until the call is over.
        if !unsafe { call(self.context, what.as_ptr(), *done, *total, status.as_ptr()) } {
            self.stopped.store(true, Ordering::Relaxed);
        }
    }
}

impl Progress for Listener {
    fn begin(&self, what: &str, total: Option<u64>, _unit: Unit) {
        self.tell(|told| {
            let what = CString::new(what).unwrap_or_default();
            *told = Told { what, total: total.unwrap_or(0), ..Told::default() };
        });
    }

    fn advance(&self, amount: u64) {
        self.tell(|told| told.done += amount);
    }

    fn end(&self) {}

    fn status(&self, text: &str) {
        self.tell(|told| told.status = CString::new(text).unwrap_or_default());
    }

    fn stopped(&self) -> bool {
        self.stopped.load(Ordering::Relaxed)
    }
}
