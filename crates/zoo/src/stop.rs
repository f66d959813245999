//! The user's wish to stop.

use std::sync::mpsc::{RecvTimeoutError, sync_channel};
use std::thread;
use std::time::Duration;

use opendr_engine::{Error, Progress};

/// How often a wait asks whether to stop.
const ASK: Duration = Duration::from_millis(100);

/// The error of work that ended because the user asked for it.
pub(crate) fn stopped() -> Error {
    Error::io("stopped; the same command goes on from here")
}

/// Does `work`, which may hang for as long as a server lets it, on a thread of its own; when the user wishes to stop,
/// the thread is left to its time limit.
///
/// # Errors
/// That of [`stopped`]; `Internal` when `work` panicked.
pub(crate) fn unless_stopped<T: Send + 'static>(
    progress: &dyn Progress,
    work: impl FnOnce() -> T + Send + 'static,
) -> Result<T, Error> {
    let (sender, receiver) = sync_channel(1);
    // Nobody may be waiting any more.
    thread::spawn(move || sender.send(work()).ok());
    loop {
        match receiver.recv_timeout(ASK) {
            Ok(done) => return Ok(done),
            Err(RecvTimeoutError::Timeout) if progress.stopped() => return Err(stopped()),
            Err(RecvTimeoutError::Timeout) => {}
            Err(RecvTimeoutError::Disconnected) => {
                return Err(Error::internal("a thread of the download is gone"));
            }
        }
    }
}
