//! Stop requests of the user.

use std::sync::mpsc::{RecvTimeoutError, sync_channel};
use std::thread;
use std::time::Duration;

use opendr_engine::{Error, Progress};

/// Interval at which a wait checks for a stop request.
const ASK: Duration = Duration::from_millis(100);

/// Returns the error of work that the user stopped.
pub(crate) fn stopped() -> Error {
    Error::io("stopped; the same command resumes")
}

/// Runs `work`, which may block on a server, on a thread of its own; after a stop request the thread is left to its time limit.
///
/// # Errors
/// That of [`stopped`]; `Internal` when `work` panicked.
pub(crate) fn unless_stopped<T: Send + 'static>(
    progress: &dyn Progress,
    work: impl FnOnce() -> T + Send + 'static,
) -> Result<T, Error> {
    let (sender, receiver) = sync_channel(1);
    // The receiver may be gone.
    thread::spawn(move || sender.send(work()).ok());
    loop {
        match receiver.recv_timeout(ASK) {
            Ok(done) => return Ok(done),
            Err(RecvTimeoutError::Timeout) if progress.stopped() => return Err(stopped()),
            Err(RecvTimeoutError::Timeout) => {}
            Err(RecvTimeoutError::Disconnected) => {
                return Err(Error::internal("a thread of the download has ended"));
            }
        }
    }
}
