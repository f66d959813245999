//! Frames read ahead in a thread of their own: videos, cameras, and iterators of a caller.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::thread::{self, JoinHandle};

use opendr_engine::{Error, Result};

use crate::source::Frame;
use crate::source::queue::{Queue, WhenFull};

/// An iterator of frames that can be interrupted.
pub(crate) trait FrameReader: Iterator<Item = Result<Frame>> + Send + 'static {
    /// Returns a function that makes a waiting `next` return, called from another thread.
    fn interrupt(&self) -> Box<dyn FnOnce() + Send>;
}

/// A frame reader in a thread of its own.
pub(super) struct Threaded {
    queue: Arc<Queue<Result<Frame>>>,
    interrupt: Option<Box<dyn FnOnce() + Send>>,
    thread: Option<JoinHandle<()>>,
}

impl Threaded {
    /// Reads up to `ahead` frames ahead without loss, or, for a live source, keeps the newest frame.
    pub(super) fn new(reader: impl FrameReader, live: bool, ahead: usize) -> Self {
        let interrupt = reader.interrupt();
        let mut reading = Self::detached(reader, live, ahead);
        reading.interrupt = Some(interrupt);
        reading
    }

    /// The same for an iterator that cannot be interrupted: its thread is not joined.
    pub(super) fn detached(
        frames: impl Iterator<Item = Result<Frame>> + Send + 'static,
        live: bool,
        ahead: usize,
    ) -> Self {
        let queue = Arc::new(match live {
            true => Queue::new(1, WhenFull::DropOldest),
            false => Queue::new(ahead, WhenFull::Wait),
        });
        let thread = thread::spawn({
            let queue = Arc::clone(&queue);
            move || produce(frames, &queue)
        });
        Self { queue, interrupt: None, thread: Some(thread) }
    }

    /// Waits until the thread has ended.
    #[cfg(test)]
    pub(super) fn wait(&mut self) {
        self.thread.take().map(JoinHandle::join);
    }

    pub(super) fn dropped(&self) -> u64 {
        self.queue.dropped()
    }
}

fn produce(mut frames: impl Iterator<Item = Result<Frame>>, queue: &Queue<Result<Frame>>) {
    loop {
        let frame = catch_unwind(AssertUnwindSafe(|| frames.next()));
        let panicked = frame.is_err();
        let frame = frame.unwrap_or_else(|_| {
            Some(Err(Error::internal("the iterator of frames panicked; please report this as a bug")))
        });
        let Some(frame) = frame else { break };
        if !queue.push(frame) || panicked {
            break;
        }
    }
    queue.close();
}

impl Iterator for Threaded {
    type Item = Result<Frame>;

    fn next(&mut self) -> Option<Result<Frame>> {
        self.queue.pop()
    }
}

impl Drop for Threaded {
    fn drop(&mut self) {
        self.queue.close();
        if let (Some(interrupt), Some(thread)) = (self.interrupt.take(), self.thread.take()) {
            interrupt();
            // `produce` catches panics.
            let _ = thread.join();
        }
    }
}

impl std::fmt::Debug for Threaded {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Threaded").finish_non_exhaustive()
    }
}
