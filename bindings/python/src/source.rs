//! Pictures, folders, videos and cameras as a Python iterator.

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

/// How often a wait for a frame looks for Ctrl-C.
const LOOK: Duration = Duration::from_millis(100);

/// Frames of a source, read in a thread that answers one question at a time, so that a camera's frame is taken when
/// it is asked for and a wait can be broken off.
#[pyclass(frozen, module = "opendr._opendr")]
pub struct Source {
    thread: Mutex<Asked>,
    length: Option<u64>,
    live: bool,
}

struct Asked {
    questions: SyncSender<()>,
    answers: Receiver<Option<Result<Frame>>>,
    /// Whether an answer is on its way that nobody has taken: the wait for it was broken off.
    waiting: bool,
}

#[pymethods]
impl Source {
    #[new]
    fn new(py: Python<'_>, inputs: Vec<PathBuf>) -> PyResult<Self> {
        let (questions, asked) = sync_channel::<()>(1);
        let (answer, answers) = sync_channel(1);
        let (tell, mut told) = sync_channel(1);
        // Opening may wait as well: for a pipe, a camera, a network's folder.
        thread::spawn(move || match Frames::open_all(inputs, SourceOptions::default()) {
            Err(error) => drop(tell.send(Err(error))),
            Ok(mut source) => {
                let known = tell.send(Ok((source.len_hint(), source.is_live())));
                while known.is_ok() && asked.recv().is_ok() && answer.send(source.next()).is_ok() {}
            }
        });
        let opened = loop {
            py.check_signals()?;
            if let Some(opened) = py.detach(|| look(&mut told)).to_python(py)? {
                break opened;
            }
        };
        let (length, live) = opened.to_python(py)?;
        Ok(Self { thread: Mutex::new(Asked { questions, answers, waiting: false }), length, live })
    }

    /// How many frames there will be, or `None`.
    #[getter]
    fn length(&self) -> Option<u64> {
        self.length
    }

    /// Whether frames are dropped that nobody has time for.
    #[getter]
    fn live(&self) -> bool {
        self.live
    }

    fn __iter__(this: PyRef<'_, Self>) -> PyRef<'_, Self> {
        this
    }

    /// The next frame: its picture, the file or device, its number there. An error is that of one frame; the next call
    /// goes on.
    fn __next__<'py>(&self, py: Python<'py>) -> PyResult<Option<(Bound<'py, PyAny>, PathBuf, u64)>> {
        loop {
            py.check_signals()?;
            let answer = py.detach(|| self.thread.lock().unwrap_or_else(PoisonError::into_inner).wait());
            match answer.to_python(py)? {
                Some(None) => return Ok(None),
                Some(Some(frame)) => {
                    let frame = frame.to_python(py)?;
                    let image = python_from_image(py, frame.image)?;
                    return Ok(Some((image, frame.path.to_path_buf(), frame.number)));
                }
                None => {}
            }
        }
    }
}

impl Asked {
    /// The answer, or `None` when there is none yet.
    fn wait(&mut self) -> Result<Option<Option<Result<Frame>>>> {
        if !self.waiting {
            self.questions.send(()).map_err(|_| gone())?;
            self.waiting = true;
        }
        let answer = look(&mut self.answers)?;
        self.waiting = answer.is_none();
        Ok(answer)
    }
}

/// What the thread tells, or `None` when it has not told yet.
fn look<T>(receiver: &mut Receiver<T>) -> Result<Option<T>> {
    match receiver.recv_timeout(LOOK) {
        Ok(told) => Ok(Some(told)),
        Err(RecvTimeoutError::Timeout) => Ok(None),
        Err(RecvTimeoutError::Disconnected) => Err(gone()),
    }
}

fn gone() -> Error {
    Error::internal("the thread that reads frames is gone")
}
