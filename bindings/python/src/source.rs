//! Images, folders, videos and cameras as a Python iterator.

use std::path::PathBuf;
use std::sync::mpsc::{Receiver, RecvTimeoutError, SyncSender, sync_channel};
use std::sync::{Mutex, PoisonError};
use std::thread;
use std::time::Duration;

use opendr::vision::{Frame, Source as Frames, SourceOptions};
use opendr::{Error, Result};
use pyo3::prelude::*;

use crate::error::ToPython;
use crate::pixels::python_from_image;

/// Interval at which a wait for a frame checks for Ctrl-C.
const POLL_INTERVAL: Duration = Duration::from_millis(100);

/// Iterator over the frames of a source. A thread reads one frame per request, so that a camera's frame is taken when it is
/// requested and a wait can be interrupted.
#[pyclass(frozen, module = "opendr._opendr")]
pub struct Source {
    reader: Mutex<Reader>,
    length: Option<u64>,
    live: bool,
}

/// Channels to the thread that reads frames.
struct Reader {
    requests: SyncSender<()>,
    frames: Receiver<Option<Result<Frame>>>,
    /// Whether a request is pending: the wait for its frame was interrupted.
    pending: bool,
}

#[pymethods]
impl Source {
    #[new]
    fn new(py: Python<'_>, inputs: Vec<PathBuf>) -> PyResult<Self> {
        let (requests, requested) = sync_channel::<()>(1);
        let (send_frame, frames) = sync_channel(1);
        let (send_opened, mut opening) = sync_channel(1);
        // Opening may block as well: on a pipe, a camera, a network folder.
        thread::spawn(move || match Frames::open_all(inputs, SourceOptions::default()) {
            Err(error) => drop(send_opened.send(Err(error))),
            Ok(mut source) => {
                let sent = send_opened.send(Ok((source.len_hint(), source.is_live())));
                while sent.is_ok() && requested.recv().is_ok() && send_frame.send(source.next()).is_ok() {}
            }
        });
        let opened = loop {
            py.check_signals()?;
            if let Some(opened) = py.detach(|| poll(&mut opening)).to_python(py)? {
                break opened;
            }
        };
        let (length, live) = opened.to_python(py)?;
        Ok(Self { reader: Mutex::new(Reader { requests, frames, pending: false }), length, live })
    }

    /// Number of frames, or `None` when unknown.
    #[getter]
    fn length(&self) -> Option<u64> {
        self.length
    }

    /// Whether frames are dropped when the caller is slower than the source.
    #[getter]
    fn live(&self) -> bool {
        self.live
    }

    fn __iter__(this: PyRef<'_, Self>) -> PyRef<'_, Self> {
        this
    }

    /// Returns the next frame: its image, the file or device, its index there. An error concerns one frame; the next call
    /// continues with the following one.
    fn __next__<'py>(&self, py: Python<'py>) -> PyResult<Option<(Bound<'py, PyAny>, PathBuf, u64)>> {
        loop {
            py.check_signals()?;
            let next = py.detach(|| self.reader.lock().unwrap_or_else(PoisonError::into_inner).wait());
            match next.to_python(py)? {
                Some(None) => return Ok(None),
                Some(Some(frame)) => {
                    let frame = frame.to_python(py)?;
                    let image = python_from_image(py, frame.image)?;
                    return Ok(Some((image, frame.path.to_path_buf(), frame.frame_index)));
                }
                None => {}
            }
        }
    }
}

impl Reader {
    /// Requests a frame and waits for it, for [`POLL_INTERVAL`]; `None` when it is not there yet.
    fn wait(&mut self) -> Result<Option<Option<Result<Frame>>>> {
        if !self.pending {
            self.requests.send(()).map_err(|_| thread_ended())?;
            self.pending = true;
        }
        let frame = poll(&mut self.frames)?;
        self.pending = frame.is_none();
        Ok(frame)
    }
}

/// Receives from the thread, or returns `None` after [`POLL_INTERVAL`].
fn poll<T>(receiver: &mut Receiver<T>) -> Result<Option<T>> {
    match receiver.recv_timeout(POLL_INTERVAL) {
        Ok(received) => Ok(Some(received)),
        Err(RecvTimeoutError::Timeout) => Ok(None),
        Err(RecvTimeoutError::Disconnected) => Err(thread_ended()),
    }
}

fn thread_ended() -> Error {
    Error::internal("the thread that reads frames has ended")
}
