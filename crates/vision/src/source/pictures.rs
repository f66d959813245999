//! Image files, decoded ahead by several threads and returned in order.

use std::collections::VecDeque;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread::{self, JoinHandle};

use opendr_engine::data::Image;
use opendr_engine::{Error, Result, ResultExt};

use crate::codec::Decoder;
use crate::source::kind::check_is_file;
use crate::source::{Frame, SourceOptions};

/// Maximum memory of decoded images that wait, in bytes; one image may always wait.
const MAX_WAITING_BYTES: usize = 96 << 20;

/// A sequence of image files.
#[derive(Debug)]
pub(super) struct Pictures {
    shared: Arc<Shared>,
    threads: Vec<JoinHandle<()>>,
}

#[derive(Debug)]
struct Shared {
    paths: Vec<Arc<Path>>,
    decoder: Decoder,
    ahead: usize,
    state: Mutex<State>,
    changed: Condvar,
}

#[derive(Debug, Default)]
struct State {
    /// Index of the consumer's next file, which is `slots[0]`.
    next_out: usize,
    /// Index of the next file to decode.
    next_in: usize,
    /// Files that are being decoded (`None`) or wait for the consumer, in order.
    slots: VecDeque<Option<Result<Image>>>,
    waiting_bytes: usize,
    closed: bool,
}

impl Pictures {
    pub(super) fn new(paths: Vec<PathBuf>, options: &SourceOptions) -> Self {
        let shared = Arc::new(Shared {
            decoder: options.decoder,
            ahead: options.prefetch.max(1),
            state: Mutex::default(),
            changed: Condvar::new(),
            paths: paths.into_iter().map(Arc::from).collect(),
        });
        let count = options.threads.max(1).min(shared.paths.len());
        let threads = (0..count).map(|_| {
            thread::spawn({
                let shared = Arc::clone(&shared);
                move || shared.work()
            })
        });
        Self { threads: threads.collect(), shared }
    }

    /// Returns the file of the last item.
    pub(super) fn last_path(&self) -> Option<&Path> {
        let last = self.shared.lock().next_out.checked_sub(1)?;
        self.shared.paths.get(last).map(|path| &**path)
    }

    /// Returns a weak reference to the shared state, which is freed when the threads have ended.
    #[cfg(test)]
    pub(super) fn watch(&self) -> std::sync::Weak<impl Sized + use<>> {
        Arc::downgrade(&self.shared)
    }
}

impl Iterator for Pictures {
    type Item = Result<Frame>;

    fn next(&mut self) -> Option<Result<Frame>> {
        let mut state = self.shared.lock();
        let path = self.shared.paths.get(state.next_out)?;
        loop {
            if let Some(Some(_)) = state.slots.front() {
                break;
            }
            state = self.shared.wait(state);
        }
        let image = state.slots.pop_front().flatten()?;
        state.next_out += 1;
        state.waiting_bytes -= bytes_of(&image);
        drop(state);
        self.shared.changed.notify_all();
        Some(image.map(|image| Frame {
            image,
            path: Arc::clone(path),
            item_index: 0,
            frame_index: 0,
            video: None,
        }))
    }
}

impl Drop for Pictures {
    fn drop(&mut self) {
        self.shared.lock().closed = true;
        self.shared.changed.notify_all();
        for thread in self.threads.drain(..) {
            // The threads catch panics of decoders.
            let _ = thread.join();
        }
    }
}

impl Shared {
    fn work(&self) {
        while let Some(index) = self.take() {
            let path = &self.paths[index];
            let image = catch_unwind(AssertUnwindSafe(|| {
                check_is_file(path).context(|| format!("opening {}", path.display()))?;
                self.decoder.open(path)
            }));
            let image = image.unwrap_or_else(|_| {
                Err(Error::internal(format!(
                    "the decoder panicked on {}; please report this file as a bug",
                    path.display()
                )))
            });
            let mut state = self.lock();
            state.waiting_bytes += bytes_of(&image);
            let slot = index - state.next_out;
            if let Some(slot) = state.slots.get_mut(slot) {
                *slot = Some(image);
            }
            drop(state);
            self.changed.notify_all();
        }
    }

    /// Returns the index of the next file to decode, after waiting for space; `None` when none is left.
    fn take(&self) -> Option<usize> {
        let mut state = self.lock();
        loop {
            if state.closed || state.next_in == self.paths.len() {
                return None;
            }
            let full = state.slots.len() >= self.ahead || state.waiting_bytes > MAX_WAITING_BYTES;
            if !full || state.slots.is_empty() {
                state.slots.push_back(None);
                state.next_in += 1;
                return Some(state.next_in - 1);
            }
            state = self.wait(state);
        }
    }

    fn lock(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn wait<'a>(&self, state: MutexGuard<'a, State>) -> MutexGuard<'a, State> {
        self.changed.wait(state).unwrap_or_else(PoisonError::into_inner)
    }
}

fn bytes_of(image: &Result<Image>) -> usize {
    image.as_ref().map_or(0, |image| image.pixels().len())
}
